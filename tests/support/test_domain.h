// tests/support/test_domain.h -- a DDS domain that no other test uses at the same time.
#pragma once

namespace cordis::test {

/// A DDS domain of this process' own, 10..101, the same at every call. Held against all other tests
/// of this machine until the process ends.
int own_domain();

}  // namespace cordis::test
