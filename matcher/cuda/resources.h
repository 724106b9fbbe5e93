#pragma once

#include "matcher/cuda/device.cuh"
#include "matcher/cuda/device.h"

#include <cstdint>
#include <string>
#include <utility>

namespace hsgm::matcher::cuda {

/// Throws DeviceError unless a call went well. Memory that is not there leaves the device as
/// it was; after anything else it is taken for lost.
inline void check(cudaError_t error, const std::string& what)
{
    if (error != cudaSuccess) {
        throw DeviceError(what + ": " + cudaGetErrorString(error),
                          error != cudaErrorMemoryAllocation);
    }
}

/// Work for a device, in order.
class Stream {
public:
    Stream()
    {
        check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "making a stream");
    }
    ~Stream() { cudaStreamDestroy(stream_); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    cudaStream_t get() const { return stream_; }
    void wait() const { check(cudaStreamSynchronize(stream_), "matching on the device"); }

private:
    cudaStream_t stream_ = nullptr;
};

/// Bytes of device memory, or of host memory that the device can reach.
template <cudaError_t (*kAllocate)(void**, std::size_t), cudaError_t (*kFree)(void*)>
class DeviceBytes {
public:
    explicit DeviceBytes(std::int64_t bytes) : bytes_(static_cast<std::size_t>(bytes))
    {
        check(kAllocate(&data_, bytes_), "allocating " + std::to_string(bytes >> 20) + " MiB");
    }
    ~DeviceBytes() { kFree(data_); }
    DeviceBytes(const DeviceBytes&) = delete;
    DeviceBytes& operator=(const DeviceBytes&) = delete;

    unsigned char* data() const { return static_cast<unsigned char*>(data_); }
    std::size_t size() const { return bytes_; }

private:
    void* data_ = nullptr;
    std::size_t bytes_;
};

inline cudaError_t allocate_device(void** pointer, std::size_t bytes)
{
    return cudaMalloc(pointer, bytes);
}
inline cudaError_t allocate_pinned(void** pointer, std::size_t bytes)
{
    return cudaMallocHost(pointer, bytes);
}
using DeviceBuffer = DeviceBytes<allocate_device, cudaFree>;
using PinnedBuffer = DeviceBytes<allocate_pinned, cudaFreeHost>;

/// Shares out a buffer, one array after the other; without a buffer it only counts. The same
/// code so plans memory and hands it out, and cannot take more than it planned.
class Arena {
public:
    Arena() = default;
    Arena(unsigned char* data, std::size_t bytes) : data_(data), bytes_(bytes)
    {
        allow_device(data, bytes);
    }

    template <typename T>
    T* take(std::size_t count)
    {
        const std::size_t begin = used_;
        const std::size_t end = begin + count * sizeof(T);
        used_ = (end + kGuardBytes + kAlignment - 1) / kAlignment * kAlignment;
        if (data_ == nullptr) {
            return nullptr;
        }
        if (used_ > bytes_) {
            throw DeviceError("a tile needs " + std::to_string(used_) +
                                  " bytes of device memory, more than the " +
                                  std::to_string(bytes_) + " planned",
                              false);
        }
        forbid_device(data_ + end, used_ - end);
        return reinterpret_cast<T*>(data_ + begin);
    }
    std::size_t used() const { return used_; }

private:
    static constexpr std::size_t kAlignment = 256;

    unsigned char* data_ = nullptr;
    std::size_t bytes_ = 0;
    std::size_t used_ = 0;
};

} // namespace hsgm::matcher::cuda
