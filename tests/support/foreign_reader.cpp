// tests/support/foreign_reader.cpp
#include "tests/support/foreign_reader.h"

#include <array>
#include <utility>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "node/dds/udp_address.h"

namespace cordis::test {
namespace {

using Octets = std::vector<std::uint8_t>;
using Entity = std::array<std::uint8_t, 4>;

// [DDSI-RTPS 9.3.1.3]
constexpr Entity kParticipant{0x00, 0x00, 0x01, 0xc1};
constexpr Entity kAnnouncer{0x00, 0x01, 0x00, 0xc2};
constexpr Entity kAsker{0x00, 0x00, 0x04, 0xc2};
constexpr Entity kAnyone{};

constexpr std::array<std::uint8_t, 12> kPrefix{0x01, 0x0f, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9};

/// Writes numbers with the low byte first.
class LittleEndianWriter {
 public:
  LittleEndianWriter& number16(std::size_t value) {
    octets_.push_back(static_cast<std::uint8_t>(value & 255U));
    octets_.push_back(static_cast<std::uint8_t>(value >> 8U));
    return *this;
  }
  LittleEndianWriter& number32(std::size_t value) {
    return number16(value & 65'535U).number16(value >> 16U);
  }
  template <class Range>
  LittleEndianWriter& octets(const Range& values) {
    octets_.insert(octets_.end(), values.begin(), values.end());
    return *this;
  }
  LittleEndianWriter& text(const std::string& value) {
    number32(value.size() + 1).octets(value);
    octets_.resize((octets_.size() + 4) / 4 * 4);
    return *this;
  }
  LittleEndianWriter& parameter(std::size_t kind, const LittleEndianWriter& value) {
    return number16(kind).number16(value.octets_.size()).octets(value.octets_);
  }
  const Octets& bytes() const { return octets_; }

 private:
  Octets octets_;
};

LittleEndianWriter guid(const Entity& entity) {
  return LittleEndianWriter().octets(kPrefix).octets(entity);
}

/// A datagram with a list of parameters [DDSI-RTPS 9.4].
Datagram datagram(const Entity& writer, std::size_t sequence, const LittleEndianWriter& list) {
  LittleEndianWriter data;
  data.number16(0).number16(16).octets(kAnyone).octets(writer).number32(0).number32(sequence);
  data.octets(Octets{0, 3, 0, 0}).octets(list.bytes()).number16(1).number16(0);
  LittleEndianWriter whole;
  whole.octets(Octets{'R', 'T', 'P', 'S', 2, 3, 0x01, 0x0f}).octets(kPrefix);
  whole.octets(Octets{0x15, 0x05}).number16(data.bytes().size()).octets(data.bytes());
  return whole.bytes();
}

}  // namespace

ForeignReaders::ForeignReaders(std::string partition, std::string topic, std::string type,
                               bool keyed)
    : partition_(std::move(partition)),
      topic_(std::move(topic)),
      type_(std::move(type)),
      kind_(keyed ? 0x07 : 0x04),
      file_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in place = dds::udp_address(0);
  socklen_t size = sizeof place;
  bind(file_, reinterpret_cast<const sockaddr*>(&place), size);
  getsockname(file_, reinterpret_cast<sockaddr*>(&place), &size);
  LittleEndianWriter locator;
  locator.number32(1).number32(ntohs(place.sin_port)).octets(std::array<std::uint8_t, 12>{});
  locator.octets(Octets{127, 0, 0, 1});
  LittleEndianWriter list;
  list.parameter(0x0015, LittleEndianWriter().octets(Octets{2, 3, 0, 0}));
  list.parameter(0x0016, LittleEndianWriter().octets(Octets{0x01, 0x0f, 0, 0}));
  list.parameter(0x0050, guid(kParticipant));
  list.parameter(0x0032, locator).parameter(0x0031, locator);
  list.parameter(0x0002, LittleEndianWriter().number32(1'000).number32(0));
  list.parameter(0x0058, LittleEndianWriter().number32(0x0c3f));
  descriptions_.push_back(datagram(kAnnouncer, 1, list));
}

ForeignReaders::~ForeignReaders() {
  close(file_);
}

void ForeignReaders::describe(std::uint8_t number, bool is_reliable) {
  const Entity reader{0x00, 0x00, number, kind_};
  LittleEndianWriter list;
  list.parameter(0x005a, guid(reader)).parameter(0x0050, guid(kParticipant));
  list.parameter(0x0005, LittleEndianWriter().text(topic_));
  list.parameter(0x0007, LittleEndianWriter().text(type_));
  list.parameter(0x0029, LittleEndianWriter().number32(1).text(partition_));
  list.parameter(0x001a,
                 LittleEndianWriter().number32(is_reliable ? 2 : 1).number32(0).number32(0));
  list.parameter(0x0070, guid(reader));
  descriptions_.push_back(datagram(kAsker, descriptions_.size(), list));
}

void ForeignReaders::send() const {
  for (const Datagram& datagram : descriptions_) send_to_all(datagram);
}

}  // namespace cordis::test
