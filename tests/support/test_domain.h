// tests/support/test_domain.h -- a DDS domain that no other test uses at the same time.
#pragma once

namespace cordis::test {

/// A DDS domain of this process' own, 10..101, the same at every call. Held against all other tests
/// of this machine, and sessions of its users, until the process ends. The programs that the test
/// starts afterwards record their sessions in a folder of this process alone, so that no other test finds them.
int own_domain();

}  // namespace cordis::test
