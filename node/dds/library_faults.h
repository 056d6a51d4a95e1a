// node/dds/library_faults.h -- five faults of Fast DDS 2.9.1 that this program takes out.
#pragma once

namespace cordis::dds {

/// Sees to it that five faults of the library end no process. The program defines six functions
/// under names of the library, which calls them in place of its own:
/// - a message with keys whose last receiver has just left is dropped, where the library aborts;
/// - one that would be too long when encrypted is sent in two, where the library loses it or aborts;
/// - what all have acknowledged stays when a receiver leaves, where the library may lock up: the
///   thread that sends holds the one lock and waits for the other, and the thread that removes the
///   other way round. It stays until newer messages take its place;
/// - a jump of numbers of samples is taken at once, where the library counts through it;
/// - a best-effort reader that says it is reliable stays what it was, where the library aborts.
/// It may be called many times, from any thread.
/// @throws std::runtime_error when the library lacks one of the functions
void take_out_library_faults();

}  // namespace cordis::dds
