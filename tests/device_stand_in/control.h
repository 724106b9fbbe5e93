#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// What a test says to the stand-in, and hears from it.
namespace hsgm::stand_in {

/// Which of the threads that could go on does so.
enum class Order {
    in_order,      ///< first come, first served: all threads abreast
    lifo,          ///< the one that became ready last
    random,        ///< any, by the seed; atomics are places to switch, too
    warp_priority, ///< one warp as far as it can go, then the next
};

struct Schedule {
    Order order = Order::in_order;
    std::uint64_t seed = 1;
    bool reversed_blocks = false;
    int resident_blocks = 1; ///< blocks that run side by side; static shared arrays forbid more
};

void set_schedule(const Schedule& schedule);
/// Every kind of schedule once, for tests that go through them all.
std::vector<Schedule> all_schedules();
std::string text(const Schedule& schedule);

/// The devices that the stand-in pretends to have.
struct DeviceTraits {
    int devices = 1;
    int driver_error = 0; ///< what counting the devices returns: 34, 35, 100; 0 = success
    int capability = 90;
    std::size_t memory_bytes = std::size_t{2} << 30;
    std::size_t shared_bytes_per_block = 227 * 1024;
    int multiprocessors = 3;
};
void set_device_traits(const DeviceTraits& traits);
const DeviceTraits& device_traits();

/// Faults to come, counted from this call; -1 = never. Each happens once, but a lost device
/// stays lost until `reset`.
struct Faults {
    int failing_allocation = -1; ///< the n-th allocation finds no memory
    int losing_launch = -1;      ///< the n-th launch loses the device
};
void set_faults(const Faults& faults);

/// What the detectors found, one sentence each, since the last `reset`.
std::vector<std::string> reports();
/// Adds a report and ends the running kernel, if any.
void report(const std::string& sentence);
/// Whether the first report ends the program; set where nobody asks for reports.
void abort_on_report(bool abort);

/// Device memory in use, and the most there ever was.
std::size_t allocated_bytes();
std::size_t peak_allocated_bytes();
/// Kernels launched so far.
std::int64_t launches();

/// Forgets reports, faults, schedule and traits; allocations stay.
void reset();

} // namespace hsgm::stand_in
