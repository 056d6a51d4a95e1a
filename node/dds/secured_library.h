// node/dds/secured_library.h -- what the DDS library needs before it joins with keys.
#pragma once

namespace cordis::dds {

/// Prepares Fast DDS for participants with keys, in this process:
/// - all messages go by sockets, also between participants of one process, and
/// - a message whose last receiver has just left is dropped, where the library aborts.
/// It may be called many times, from any thread.
/// @throws std::runtime_error when the library is not the one that this program was built with
void prepare_secured_library();

}  // namespace cordis::dds
