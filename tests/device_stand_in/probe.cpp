// Kernels with one fault each, and one without: what the detectors of the stand-in must find.

#include <cuda_runtime.h>

#include "tests/device_stand_in/control.h"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace stand_in = hsgm::stand_in;

// Not in a namespace without a name, as hsgm's own kernels are not.
namespace probe {

constexpr int kThreads = 64;

__device__ unsigned* shared_words()
{
    return reinterpret_cast<unsigned*>(stand_in::dynamic_shared());
}

/// Every thread passes its number through shared memory to the thread opposite, and the
/// block's sum, by atomics, to everybody.
__global__ void exchange(unsigned* out, bool barrier)
{
    unsigned* const words = shared_words();
    const unsigned t = threadIdx.x;
    words[t] = t + 1;
    if (t == 0) {
        words[blockDim.x] = 0;
    }
    if (barrier) {
        __syncthreads();
    }
    const unsigned opposite = words[blockDim.x - 1 - t];
    __syncthreads();
    atomicAdd(&words[blockDim.x], opposite);
    __syncthreads();
    out[blockIdx.x * blockDim.x + t] = opposite * 10000 + words[blockDim.x];
}

/// The same within a warp.
__global__ void exchange_in_warp(unsigned* out, bool sync)
{
    unsigned* const words = shared_words();
    const unsigned t = threadIdx.x;
    words[t] = t + 1;
    if (sync) {
        __syncwarp();
    }
    const unsigned opposite = words[t ^ 31U];
    const unsigned sum = __shfl_xor_sync(~0U, opposite, 1) + opposite;
    __syncwarp();
    out[blockIdx.x * blockDim.x + t] = sum;
}

__global__ void minimum(unsigned* out, bool atomic)
{
    const unsigned value = 1000 - threadIdx.x;
    if (atomic) {
        atomicMin(out, value);
    } else if (value < *out) {
        *out = value;
    }
}

__global__ void write_same_word(unsigned* out)
{
    out[threadIdx.x] = blockIdx.x;
}

__global__ void barrier_lines()
{
    if (threadIdx.x < 32) {
        __syncthreads();
    } else {
        __syncthreads();
    }
}

__global__ void early_leave()
{
    if (threadIdx.x == 7) {
        return;
    }
    __syncthreads();
}

__global__ void warp_lines(unsigned* out)
{
    const unsigned t = threadIdx.x;
    if (t % 2 == 0) {
        out[t] = __shfl_xor_sync(~0U, t, 1);
    } else {
        out[t] = __shfl_xor_sync(~0U, t, 1);
    }
}

__global__ void foreign_mask()
{
    __syncwarp(0x0000FFFFU);
}

__global__ void lost_lane()
{
    if (threadIdx.x != 5) {
        __syncwarp();
    }
}

__global__ void outside_lane(unsigned* out)
{
    if (threadIdx.x < 16) {
        out[threadIdx.x] = __shfl_sync(0x0000FFFFU, threadIdx.x, 20);
    }
}

__global__ void barrier_in_warp()
{
    if (threadIdx.x % 32 == 3) {
        __syncthreads();
    }
    __syncwarp();
}

__global__ void shared_access(unsigned* out, int at, bool write)
{
    unsigned* const words = shared_words();
    words[threadIdx.x] = 1;
    if (write) {
        words[at] = 1;
    } else {
        out[0] = words[at];
    }
}

__global__ void device_access(unsigned* out, int at, bool write)
{
    if (write) {
        out[at] = 1;
    } else {
        out[0] = out[at];
    }
}

/// Device memory for `words`, and a stream.
struct Bench {
    unsigned* words = nullptr;
    cudaStream_t stream = nullptr;
    std::size_t count;

    explicit Bench(std::size_t n) : count(n)
    {
        cudaMalloc(reinterpret_cast<void**>(&words), n * sizeof(unsigned));
        cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking);
        cudaMemsetAsync(words, 0x7F, n * sizeof(unsigned), stream);
    }
    template <typename Kernel, typename... Arguments>
    std::vector<unsigned> run(Kernel kernel, unsigned blocks, Arguments... arguments)
    {
        stand_in::launch(kernel, dim3{blocks}, dim3{kThreads}, (kThreads + 1) * 4, stream,
                         arguments...);
        std::vector<unsigned> result(count);
        cudaMemcpyAsync(result.data(), words, count * sizeof(unsigned), cudaMemcpyDeviceToHost,
                        stream);
        cudaStreamSynchronize(stream);
        return result;
    }
};

std::string under_all_schedules(const std::string& fault)
{
    const bool in_warp = fault == "missing-syncwarp";
    std::vector<unsigned> expected(2 * kThreads);
    for (unsigned i = 0; i < expected.size(); ++i) {
        const unsigned t = i % kThreads;
        expected[i] = in_warp ? (t ^ 31U) + 1 + (t ^ 30U) + 1
                              : (kThreads - t) * 10000 + kThreads * (kThreads + 1) / 2;
    }
    for (const stand_in::Schedule& schedule : stand_in::all_schedules()) {
        stand_in::set_schedule(schedule);
        Bench bench(2 * kThreads);
        const auto result = in_warp ? bench.run(exchange_in_warp, 2, bench.words, false)
                                    : bench.run(exchange, 2, bench.words, fault == "nothing");
        if (result != expected) {
            return "wrong under " + stand_in::text(schedule);
        }
        Bench other(1);
        if (other.run(minimum, 2, other.words, true).front() != 1000 - kThreads + 1) {
            return "wrong minimum under " + stand_in::text(schedule);
        }
    }
    return "every schedule is clean";
}

void carry_out(const std::string& fault)
{
    Bench bench(kThreads);
    unsigned* const words = bench.words;
    if (fault == "barrier-lines") {
        bench.run(barrier_lines, 1);
    } else if (fault == "early-leave") {
        bench.run(early_leave, 1);
    } else if (fault == "warp-lines") {
        bench.run(warp_lines, 1, words);
    } else if (fault == "foreign-mask") {
        bench.run(foreign_mask, 1);
    } else if (fault == "lost-lane") {
        bench.run(lost_lane, 1);
    } else if (fault == "outside-lane") {
        bench.run(outside_lane, 1, words);
    } else if (fault == "barrier-in-warp") {
        bench.run(barrier_in_warp, 1);
    } else if (fault == "shared-write" || fault == "shared-read") {
        bench.run(shared_access, 1, words, kThreads + 1, fault == "shared-write");
    } else if (fault == "device-write" || fault == "device-read") {
        bench.run(device_access, 1, words, -1, fault == "device-write");
    } else if (fault == "plain-minimum") {
        bench.run(minimum, 1, words, false);
    } else if (fault == "two-blocks") {
        bench.run(write_same_word, 2, words);
    } else if (fault == "copy-outside") {
        cudaMemsetAsync(words + 1, 0, kThreads * sizeof(unsigned), bench.stream);
    } else {
        std::puts(under_all_schedules(fault).c_str());
    }
}

} // namespace probe

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::puts("device_stand_in_probe FAULT");
        return 2;
    }
    probe::carry_out(argv[1]);
    return 0;
}
