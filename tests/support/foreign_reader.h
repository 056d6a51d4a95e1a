// tests/support/foreign_reader.h -- readers of another program, which exist in its packets alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/datagrams.h"

namespace cordis::test {

/// A participant of own_domain() that describes its readers as a test wants it, and reads nothing.
class ForeignReaders {
 public:
  /// @param partition  the name of a session
  ForeignReaders(std::string partition, std::string topic, std::string type, bool keyed);
  ~ForeignReaders();
  ForeignReaders(const ForeignReaders&) = delete;
  ForeignReaders& operator=(const ForeignReaders&) = delete;

  /// Describes one of them, from the next send() on. @param number  1 to 255
  void describe(std::uint8_t number, bool is_reliable);

  /// Sends all descriptions so far to each participant of own_domain(), in their order.
  void send() const;

 private:
  std::string partition_;
  std::string topic_;
  std::string type_;
  std::uint8_t kind_;  // the last byte of the number of a reader
  int file_;
  std::vector<Datagram> descriptions_;
};

}  // namespace cordis::test
