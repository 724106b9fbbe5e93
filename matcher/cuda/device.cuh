#pragma once

// The few places where a kernel's source must know who compiles it: nvcc for a device, or a
// plain C++ compiler for the stand-in of tests/device_stand_in.

#include <cuda_runtime.h>

#include <cstddef>
#include <type_traits>

namespace hsgm::matcher::cuda {

/// Of every warp, all lanes.
constexpr unsigned kAllLanes = 0xFFFFFFFFU;
constexpr int kWarp = 32;

#if defined(HSGM_DEVICE_STAND_IN)

/// Forbidden bytes between the arrays of one allocation, so that a step too far shows.
constexpr std::size_t kGuardBytes = 64;

inline unsigned char* dynamic_shared()
{
    return reinterpret_cast<unsigned char*>(stand_in::dynamic_shared());
}
inline void forbid_shared(unsigned char* begin, std::size_t bytes)
{
    stand_in::forbid_shared(reinterpret_cast<std::byte*>(begin), bytes);
}
inline void forbid_device(void* begin, std::size_t bytes)
{
    stand_in::forbid_device(begin, bytes);
}
inline void allow_device(void* begin, std::size_t bytes)
{
    stand_in::allow_device(begin, bytes);
}

template <typename... Parameters, typename... Arguments>
cudaError_t launch(void (*kernel)(Parameters...), int blocks, int threads, std::size_t shared,
                   cudaStream_t stream, const Arguments&... arguments)
{
    return stand_in::launch(kernel, dim3{static_cast<unsigned>(blocks)},
                            dim3{static_cast<unsigned>(threads)}, shared, stream, arguments...);
}

#else

constexpr std::size_t kGuardBytes = 0;

__device__ inline unsigned char* dynamic_shared()
{
    extern __shared__ __align__(16) unsigned char hsgm_dynamic_shared[];
    return hsgm_dynamic_shared;
}
__device__ inline void forbid_shared(unsigned char*, std::size_t) {}
inline void forbid_device(void*, std::size_t) {}
inline void allow_device(void*, std::size_t) {}

/// Puts a kernel into a stream. Arguments become the kernel's parameter types first.
template <typename... Parameters, typename... Arguments>
cudaError_t launch(void (*kernel)(Parameters...), int blocks, int threads, std::size_t shared,
                   cudaStream_t stream, const Arguments&... arguments)
{
    const auto call = [&](std::remove_cv_t<Parameters>... values) {
        void* pointers[] = {&values...};
        return cudaLaunchKernel(reinterpret_cast<const void*>(kernel),
                                dim3(static_cast<unsigned>(blocks)),
                                dim3(static_cast<unsigned>(threads)), pointers, shared, stream);
    };
    return call(arguments...);
}

#endif

} // namespace hsgm::matcher::cuda
