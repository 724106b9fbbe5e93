#include "tests/catch.h"

#include <cuda_runtime.h>

#include "tests/device_stand_in/control.h"

namespace stand_in = hsgm::stand_in;

namespace runtime_test {

__global__ void add_one(unsigned* words)
{
    words[threadIdx.x] += 1;
}

} // namespace runtime_test

TEST_CASE("a stream works when somebody waits for it, not earlier")
{
    unsigned* words = nullptr;
    cudaStream_t stream = nullptr;
    REQUIRE(cudaMalloc(reinterpret_cast<void**>(&words), 128) == cudaSuccess);
    REQUIRE(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking) == cudaSuccess);
    unsigned host = 1;
    cudaMemcpyAsync(words, &host, 4, cudaMemcpyHostToDevice, stream);
    host = 41;
    stand_in::launch(runtime_test::add_one, dim3{1}, dim3{1}, 0, stream, words);
    cudaMemcpyAsync(&host, words, 4, cudaMemcpyDeviceToHost, stream);
    CHECK(host == 41);
    CHECK(cudaStreamSynchronize(stream) == cudaSuccess);
    CHECK(host == 42);
    cudaStreamDestroy(stream);
    cudaFree(words);
}

TEST_CASE("device memory is counted, limited, and full of rubbish at first")
{
    stand_in::DeviceTraits traits;
    traits.memory_bytes = 1 << 20;
    stand_in::set_device_traits(traits);
    const std::size_t before = stand_in::allocated_bytes();
    void* first = nullptr;
    void* second = nullptr;
    REQUIRE(cudaMalloc(&first, 600 << 10) == cudaSuccess);
    CHECK(stand_in::allocated_bytes() == before + (600 << 10));
    CHECK(cudaMalloc(&second, 600 << 10) == cudaErrorMemoryAllocation);
    CHECK(static_cast<unsigned char*>(first)[100] == 0xCD);
    std::size_t free = 0;
    std::size_t total = 0;
    CHECK(cudaMemGetInfo(&free, &total) == cudaSuccess);
    CHECK(total == 1 << 20);
    CHECK(free == total - stand_in::allocated_bytes());
    CHECK(cudaFree(first) == cudaSuccess);
    CHECK(stand_in::allocated_bytes() == before);
    stand_in::reset();
}

TEST_CASE("a driver that is missing, and devices that are not there, give their errors")
{
    stand_in::DeviceTraits traits;
    traits.driver_error = 35;
    stand_in::set_device_traits(traits);
    int count = 7;
    CHECK(cudaGetDeviceCount(&count) == cudaErrorInsufficientDriver);
    CHECK(count == 0);
    traits.driver_error = 0;
    traits.devices = 0;
    stand_in::set_device_traits(traits);
    CHECK(cudaGetDeviceCount(&count) == cudaErrorNoDevice);
    stand_in::reset();
    CHECK(cudaGetDeviceCount(&count) == cudaSuccess);
    CHECK(count == 1);
    CHECK(cudaSetDevice(1) == cudaErrorInvalidDevice);
}

TEST_CASE("faults come when they were ordered, and a lost device stays lost")
{
    stand_in::set_faults({1, -1});
    void* first = nullptr;
    void* second = nullptr;
    CHECK(cudaMalloc(&first, 16) == cudaSuccess);
    CHECK(cudaMalloc(&second, 16) == cudaErrorMemoryAllocation);
    CHECK(cudaMalloc(&second, 16) == cudaSuccess);
    cudaFree(second);
    cudaStream_t stream = nullptr;
    cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking);
    stand_in::set_faults({-1, 0});
    stand_in::launch(runtime_test::add_one, dim3{1}, dim3{1}, 0, stream,
                     static_cast<unsigned*>(first));
    CHECK(cudaStreamSynchronize(stream) == cudaErrorLaunchFailure);
    CHECK(cudaMalloc(&second, 16) == cudaErrorLaunchFailure);
    stand_in::reset();
    CHECK(cudaStreamSynchronize(stream) == cudaSuccess);
    cudaStreamDestroy(stream);
    cudaFree(first);
}

TEST_CASE("reports are kept for those who ask")
{
    stand_in::abort_on_report(false);
    int on_the_host = 0;
    CHECK(cudaFree(&on_the_host) == cudaErrorInvalidValue);
    REQUIRE(stand_in::reports().size() == 1);
    CHECK(stand_in::reports()[0] == "device memory was freed that was not allocated");
    stand_in::reset();
    CHECK(stand_in::reports().empty());
}
