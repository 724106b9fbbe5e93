#pragma once

// What the C library does with memory that the program has freed.
namespace hsgm::pipeline {

/// Keeps it for the next request, for the rest of the process. Tiles take and free the same
/// tens of megabytes over and over; to give them back to the system each time and get them
/// anew, cleared, takes a tenth of the computing time. All threads share what is kept.
void keep_freed_memory();

/// Gives back to the system what has been kept until now: the plan counts stages one by one,
/// and the next one does not need what the last one has freed.
void give_back_freed_memory();

} // namespace hsgm::pipeline
