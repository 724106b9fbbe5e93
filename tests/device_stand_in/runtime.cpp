#include <cuda_runtime.h>

#include "tests/device_stand_in/device_memory.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <list>
#include <mutex>

// What a stream still has to do, in its order.
struct StandInStream {
    std::list<std::function<cudaError_t()>> work;
};

namespace hsgm::stand_in {

namespace {

struct Machine {
    std::recursive_mutex lock;
    Schedule schedule;
    DeviceTraits traits;
    Faults faults;
    std::vector<std::string> reports;
    bool abort_on_report = true;
    DeviceMemory memory;
    std::list<StandInStream> streams;
    std::int64_t launches = 0;
    bool lost = false;
};

Machine& machine()
{
    static Machine the_machine;
    return the_machine;
}

using Lock = std::scoped_lock<std::recursive_mutex>;

bool counted_down(int& counter)
{
    return counter >= 0 && counter-- == 0;
}

cudaError_t drain(StandInStream& stream)
{
    Machine& m = machine();
    while (!stream.work.empty()) {
        const auto work = std::move(stream.work.front());
        stream.work.pop_front();
        if (!m.lost && work() != cudaSuccess) {
            m.lost = true;
        }
    }
    return m.lost ? cudaErrorLaunchFailure : cudaSuccess;
}

cudaError_t enqueue(cudaStream_t stream, std::function<cudaError_t()> work)
{
    if (machine().lost) {
        return cudaErrorLaunchFailure;
    }
    if (stream == nullptr) {
        report("something was put into no stream");
        return cudaErrorInvalidValue;
    }
    stream->work.push_back(std::move(work));
    return cudaSuccess;
}

cudaError_t run_now(dim3 grid, dim3 block, std::size_t shared_bytes,
                    const std::function<void()>& body)
{
    Machine& m = machine();
    const std::string failure = run_kernel(
        {grid.x, grid.y, grid.z}, {block.x, block.y, block.z}, shared_bytes, m.schedule, body);
    if (!failure.empty()) {
        report(failure);
        return cudaErrorLaunchFailure;
    }
    if (!m.memory.intact()) {
        report("a kernel wrote outside its array in device memory");
        return cudaErrorLaunchFailure;
    }
    return cudaSuccess;
}

} // namespace

void set_schedule(const Schedule& schedule)
{
    const Lock lock(machine().lock);
    machine().schedule = schedule;
}

std::vector<Schedule> all_schedules()
{
    return {{},
            {Order::lifo, 1, false, 1},
            {Order::random, 1, false, 3},
            {Order::random, 2, true, 2},
            {Order::warp_priority, 1, false, 1},
            {Order::warp_priority, 1, true, 2},
            {Order::in_order, 1, true, 1}};
}

std::string text(const Schedule& schedule)
{
    static constexpr const char* kNames[] = {"in order", "lifo", "random", "warp priority"};
    return std::string(kNames[static_cast<int>(schedule.order)]) + ", seed " +
           std::to_string(schedule.seed) +
           (schedule.reversed_blocks ? ", blocks reversed" : "") + ", " +
           std::to_string(schedule.resident_blocks) + " blocks at once";
}

void set_device_traits(const DeviceTraits& traits)
{
    const Lock lock(machine().lock);
    machine().traits = traits;
}

const DeviceTraits& device_traits()
{
    return machine().traits;
}

void set_faults(const Faults& faults)
{
    const Lock lock(machine().lock);
    machine().faults = faults;
}

std::vector<std::string> reports()
{
    const Lock lock(machine().lock);
    return machine().reports;
}

void report(const std::string& sentence)
{
    const Lock lock(machine().lock);
    machine().reports.push_back(sentence);
    if (machine().abort_on_report) {
        std::fprintf(stderr, "device stand-in: %s\n", sentence.c_str());
        std::_Exit(EXIT_FAILURE);
    }
}

void abort_on_report(bool abort)
{
    const Lock lock(machine().lock);
    machine().abort_on_report = abort;
}

std::size_t allocated_bytes()
{
    const Lock lock(machine().lock);
    return machine().memory.used();
}

std::size_t peak_allocated_bytes()
{
    const Lock lock(machine().lock);
    return machine().memory.peak();
}

std::int64_t launches()
{
    const Lock lock(machine().lock);
    return machine().launches;
}

void reset()
{
    Machine& m = machine();
    const Lock lock(m.lock);
    m.schedule = {};
    m.traits = {};
    m.faults = {};
    m.reports.clear();
    m.abort_on_report = true;
    m.lost = false;
    m.memory.forget_peak();
}

void forbid_device(void* begin, std::size_t bytes)
{
    const Lock lock(machine().lock);
    machine().memory.forbid(static_cast<std::byte*>(begin), bytes);
}

void allow_device(void* begin, std::size_t bytes)
{
    const Lock lock(machine().lock);
    machine().memory.allow(static_cast<std::byte*>(begin), bytes);
}

cudaError_t enqueue_kernel(dim3 grid, dim3 block, std::size_t shared_bytes, cudaStream_t stream,
                           std::function<void()> body)
{
    Machine& m = machine();
    const Lock lock(m.lock);
    ++m.launches;
    if (counted_down(m.faults.losing_launch)) {
        m.lost = true;
    }
    if (shared_bytes > m.traits.shared_bytes_per_block || block.x * block.y * block.z > 1024 ||
        block.x == 0 || grid.x == 0) {
        report("a kernel was launched with " + std::to_string(shared_bytes) +
               " bytes of shared memory, " + std::to_string(block.x) + " threads a block and " +
               std::to_string(grid.x) + " blocks");
        return cudaErrorInvalidValue;
    }
    return enqueue(stream, [grid, block, shared_bytes, body = std::move(body)] {
        return run_now(grid, block, shared_bytes, body);
    });
}

} // namespace hsgm::stand_in

using namespace hsgm::stand_in;

const char* cudaGetErrorString(cudaError_t error)
{
    switch (error) {
    case cudaSuccess:
        return "no error";
    case cudaErrorMemoryAllocation:
        return "out of memory";
    case cudaErrorInsufficientDriver:
        return "CUDA driver version is insufficient for CUDA runtime version";
    case cudaErrorNoDevice:
        return "no CUDA-capable device is detected";
    case cudaErrorLaunchFailure:
        return "unspecified launch failure";
    default:
        return "another error";
    }
}

cudaError_t cudaGetLastError()
{
    return cudaSuccess;
}

cudaError_t cudaGetDeviceCount(int* count)
{
    const DeviceTraits& traits = device_traits();
    *count = traits.driver_error == 0 ? traits.devices : 0;
    if (traits.driver_error != 0) {
        return static_cast<cudaError_t>(traits.driver_error);
    }
    return traits.devices == 0 ? cudaErrorNoDevice : cudaSuccess;
}

cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device)
{
    const DeviceTraits& traits = device_traits();
    if (device < 0 || device >= traits.devices) {
        return cudaErrorInvalidDevice;
    }
    *properties = {};
    std::snprintf(properties->name, sizeof properties->name, "stand-in %d", device);
    properties->totalGlobalMem = traits.memory_bytes;
    properties->sharedMemPerBlockOptin = traits.shared_bytes_per_block;
    properties->multiProcessorCount = traits.multiprocessors;
    properties->major = traits.capability / 10;
    properties->minor = traits.capability % 10;
    return cudaSuccess;
}

cudaError_t cudaSetDevice(int device)
{
    return device >= 0 && device < device_traits().devices ? cudaSuccess
                                                           : cudaErrorInvalidDevice;
}

cudaError_t cudaMemGetInfo(std::size_t* free, std::size_t* total)
{
    *total = device_traits().memory_bytes;
    *free = *total - std::min(*total, allocated_bytes());
    return cudaSuccess;
}

cudaError_t cudaMalloc(void** pointer, std::size_t bytes)
{
    Machine& m = machine();
    const Lock lock(m.lock);
    if (m.lost) {
        return cudaErrorLaunchFailure;
    }
    *pointer = counted_down(m.faults.failing_allocation)
                   ? nullptr
                   : m.memory.allocate(bytes, m.traits.memory_bytes);
    return *pointer == nullptr ? cudaErrorMemoryAllocation : cudaSuccess;
}

cudaError_t cudaFree(void* pointer)
{
    Machine& m = machine();
    const Lock lock(m.lock);
    for (StandInStream& stream : m.streams) {
        drain(stream);
    }
    if (pointer != nullptr && !m.memory.release(pointer)) {
        report("device memory was freed that was not allocated");
        return cudaErrorInvalidValue;
    }
    return m.lost ? cudaErrorLaunchFailure : cudaSuccess;
}

cudaError_t cudaMallocHost(void** pointer, std::size_t bytes)
{
    *pointer = std::malloc(bytes);
    return *pointer == nullptr ? cudaErrorMemoryAllocation : cudaSuccess;
}

cudaError_t cudaFreeHost(void* pointer)
{
    std::free(pointer);
    return cudaSuccess;
}

cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                            cudaStream_t stream)
{
    Machine& m = machine();
    const Lock lock(m.lock);
    if (!m.memory.holds(kind == cudaMemcpyHostToDevice ? to : from, bytes)) {
        report("a copy reaches outside the device memory allocated");
        return cudaErrorInvalidValue;
    }
    return enqueue(stream, [=] {
        std::memcpy(to, from, bytes);
        return cudaSuccess;
    });
}

cudaError_t cudaMemsetAsync(void* to, int value, std::size_t bytes, cudaStream_t stream)
{
    Machine& m = machine();
    const Lock lock(m.lock);
    if (!m.memory.holds(to, bytes)) {
        report("a fill reaches outside the device memory allocated");
        return cudaErrorInvalidValue;
    }
    return enqueue(stream, [=] {
        std::memset(to, value, bytes);
        return cudaSuccess;
    });
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned)
{
    Machine& m = machine();
    const Lock lock(m.lock);
    *stream = &m.streams.emplace_back();
    return m.lost ? cudaErrorLaunchFailure : cudaSuccess;
}

cudaError_t cudaStreamDestroy(cudaStream_t stream)
{
    Machine& m = machine();
    const Lock lock(m.lock);
    drain(*stream);
    m.streams.remove_if([stream](const StandInStream& s) { return &s == stream; });
    return cudaSuccess;
}

cudaError_t cudaStreamSynchronize(cudaStream_t stream)
{
    const Lock lock(machine().lock);
    return drain(*stream);
}

cudaError_t cudaFuncSetAttribute(const void*, cudaFuncAttribute, int value)
{
    return static_cast<std::size_t>(value) <= device_traits().shared_bytes_per_block
               ? cudaSuccess
               : cudaErrorInvalidValue;
}

cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessor(int* blocks, const void*, int,
                                                          std::size_t)
{
    *blocks = 1;
    return cudaSuccess;
}
