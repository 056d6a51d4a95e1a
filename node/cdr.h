// node/cdr.h -- how a message begins on the wire, for every folder: it includes nothing of Cordis.
#pragma once

#include <cstddef>

namespace cordis {

/// Bytes of the encapsulation before the CDR of a message: two for its kind, two of options [DDSI 10].
inline constexpr std::size_t kEncapsulationBytes = 4;

}  // namespace cordis
