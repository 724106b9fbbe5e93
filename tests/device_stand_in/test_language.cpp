#include "tests/catch.h"

#include <cuda_runtime.h>

#include "tests/device_stand_in/control.h"

#include <cstdint>
#include <vector>

namespace stand_in = hsgm::stand_in;

// The language of the device does on the stand-in what NVIDIA's manual says.
namespace language_test {

__global__ void collectives(unsigned* out)
{
    const unsigned t = threadIdx.x;
    unsigned* const mine = out + t * 10;
    mine[0] = __shfl_sync(~0U, t, 3);
    mine[1] = __shfl_sync(~0U, t, 11, 8);
    mine[2] = __shfl_xor_sync(~0U, t, 4);
    mine[3] = __shfl_up_sync(~0U, t, 1, 8);
    mine[4] = __shfl_down_sync(~0U, t, 2, 16);
    mine[5] = static_cast<unsigned>(__any_sync(~0U, t % 32 == 9));
    mine[6] = static_cast<unsigned>(__all_sync(~0U, t < 32));
    mine[7] = __ballot_sync(~0U, t % 2 == 1);
    mine[8] = __reduce_min_sync(~0U, 100 + (t * 7) % 64);
    mine[9] = static_cast<unsigned>(__syncthreads_or(t == 63)) * 2 +
              static_cast<unsigned>(__syncthreads_and(t < 60));
}

__global__ void half_warps(unsigned* out)
{
    const unsigned t = threadIdx.x;
    const unsigned mask = t % 32 < 16 ? 0x0000FFFFU : 0xFFFF0000U;
    if (t % 32 < 16) {
        out[t] = __shfl_xor_sync(mask, t, 1);
    } else {
        out[t] = __shfl_xor_sync(mask, t, 2);
    }
}

__global__ void static_array(unsigned* out)
{
    __shared__ unsigned values[64];
    values[threadIdx.x] = threadIdx.x;
    __syncthreads();
    out[threadIdx.x] = values[63 - threadIdx.x];
}

} // namespace language_test

namespace {

template <typename Kernel>
std::vector<unsigned> run(Kernel kernel, unsigned blocks, unsigned threads, std::size_t words)
{
    unsigned* out = nullptr;
    cudaMalloc(reinterpret_cast<void**>(&out), words * 4);
    cudaStream_t stream = nullptr;
    cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking);
    stand_in::launch(kernel, dim3{blocks}, dim3{threads}, 0, stream, out);
    std::vector<unsigned> result(words);
    cudaMemcpyAsync(result.data(), out, words * 4, cudaMemcpyDeviceToHost, stream);
    cudaStreamSynchronize(stream);
    cudaStreamDestroy(stream);
    cudaFree(out);
    return result;
}

} // namespace

TEST_CASE("shuffles, votes and barriers give what the manual says under every schedule")
{
    for (const stand_in::Schedule& schedule : stand_in::all_schedules()) {
        stand_in::set_schedule(schedule);
        INFO(stand_in::text(schedule));
        const auto result = run(language_test::collectives, 1, 64, 640);
        for (unsigned t = 0; t < 64; ++t) {
            CAPTURE(t);
            const unsigned* const r = result.data() + std::size_t(t) * 10;
            const unsigned warp = t / 32 * 32;
            CHECK(r[0] == warp + 3);
            CHECK(r[1] == t / 8 * 8 + 3);
            CHECK(r[2] == (t ^ 4U));
            CHECK(r[3] == (t % 8 == 0 ? t : t - 1));
            CHECK(r[4] == (t % 16 >= 14 ? t : t + 2));
            CHECK(r[5] == 1);
            CHECK(r[6] == (t < 32 ? 1 : 0));
            CHECK(r[7] == 0xAAAAAAAAU);
            unsigned least = ~0U;
            for (unsigned i = warp; i < warp + 32; ++i) {
                least = std::min(least, 100 + i * 7 % 64);
            }
            CHECK(r[8] == least);
            CHECK(r[9] == 2);
        }
    }
    stand_in::reset();
}

TEST_CASE("parts of a warp may meet at different lines if their masks say so")
{
    const auto result = run(language_test::half_warps, 1, 64, 64);
    for (unsigned t = 0; t < 64; ++t) {
        CHECK(result[t] == (t % 32 < 16 ? (t ^ 1U) : (t ^ 2U)));
    }
}

TEST_CASE("static shared arrays are shared")
{
    const auto result = run(language_test::static_array, 1, 64, 64);
    for (unsigned i = 0; i < 64; ++i) {
        CHECK(result[i] == 63 - i);
    }
}

TEST_CASE("packed arithmetic keeps its fields apart")
{
    CHECK(__vminu2(0x00050007, 0x00060003) == 0x00050003);
    CHECK(__vminu2(0xFFFF0000, 0x8000FFFF) == 0x80000000);
    CHECK(__vminu4(0x01FF8000, 0x02FE7F01) == 0x01FE7F00);
    CHECK(__vaddus4(0xFF018000, 0x01027F10) == 0xFF03FF10);
    CHECK(__viaddmin_u16x2(0x00010010, 0x00010010, 0x0001FFFF) == 0x00010020);
    CHECK(__vimin3_u16x2(0x00050001, 0x00040002, 0x00060003) == 0x00040001);
    CHECK(__byte_perm(0x33221100, 0x77665544, 0x6420) == 0x66442200);
    CHECK(__byte_perm(0x33221100, 0, 0x4341) == 0x00330011);
    CHECK(__popc(0xF0F00001) == 9);
}
