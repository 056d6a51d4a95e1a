// tests/node/datagram_filter_test.cpp -- what of a datagram Fast DDS may read, by the standard.
#include "node/dds/datagram_filter.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include <gtest/gtest.h>

namespace cordis::dds {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Writes numbers in one of the two orders of bytes.
class BodyWriter {
 public:
  explicit BodyWriter(bool is_little) : is_little_(is_little) {}

  BodyWriter& octets(std::initializer_list<int> values) {
    for (const int value : values) bytes_.push_back(static_cast<std::uint8_t>(value));
    return *this;
  }
  BodyWriter& number16(unsigned value) {
    return is_little_ ? octets({static_cast<int>(value & 255U), static_cast<int>(value >> 8U)})
                      : octets({static_cast<int>(value >> 8U), static_cast<int>(value & 255U)});
  }
  BodyWriter& number32(std::uint32_t value) {
    return is_little_ ? number16(value & 65535U).number16(value >> 16U)
                      : number16(value >> 16U).number16(value & 65535U);
  }
  BodyWriter& sequence(std::int64_t value) {
    return number32(static_cast<std::uint32_t>(static_cast<std::uint64_t>(value) >> 32U))
        .number32(static_cast<std::uint32_t>(value));
  }
  BodyWriter& fill(std::size_t count) {
    bytes_.resize(bytes_.size() + count, 7);
    return *this;
  }
  const Bytes& bytes() const { return bytes_; }

 private:
  bool is_little_;
  Bytes bytes_;
};

class DatagramFilter : public testing::TestWithParam<bool> {
 protected:
  static BodyWriter body() { return BodyWriter(GetParam()); }

  static Bytes submessage(int kind, unsigned flags, const BodyWriter& body) {
    BodyWriter whole(GetParam());
    whole.octets({kind, static_cast<int>(flags | (GetParam() ? 1U : 0U))});
    whole.number16(static_cast<unsigned>(body.bytes().size()));
    Bytes bytes = whole.bytes();
    bytes.insert(bytes.end(), body.bytes().begin(), body.bytes().end());
    return bytes;
  }

  static Bytes message(const std::vector<Bytes>& parts, int vendor = 0x0f) {
    Bytes bytes{'R', 'T', 'P', 'S', 2, 3, 1, static_cast<std::uint8_t>(vendor)};
    bytes.resize(20, 5);
    for (const Bytes& part : parts) bytes.insert(bytes.end(), part.begin(), part.end());
    return bytes;
  }

  static std::size_t read(const Bytes& datagram, bool is_secured = false) {
    return bytes_to_read(datagram.data(), static_cast<std::uint32_t>(datagram.size()), is_secured);
  }
  static bool passes(const Bytes& part) {
    const Bytes whole = message({part});
    return read(whole) == whole.size();
  }

  static Bytes data(unsigned flags, std::size_t payload, std::int64_t sequence = 1,
                    unsigned offset = 16) {
    BodyWriter fields = body();
    fields.number16(0).number16(offset).fill(8).sequence(sequence).fill(offset - 16);
    return submessage(0x15, flags, fields.fill(payload));
  }
  static Bytes fragment(std::uint32_t number, unsigned count, unsigned length, std::uint32_t whole,
                        std::size_t payload) {
    BodyWriter fields = body();
    fields.number16(0).number16(28).fill(8).sequence(1).number32(number).number16(count);
    return submessage(0x16, 0, fields.number16(length).number32(whole).fill(payload));
  }
  static Bytes gap(std::int64_t start, std::int64_t base, std::uint32_t bits, std::size_t words) {
    return submessage(0x08, 0,
                      body().fill(8).sequence(start).sequence(base).number32(bits).fill(4 * words));
  }
  static Bytes acknowledgement(std::int64_t base, std::uint32_t bits, std::size_t words) {
    return submessage(0x06, 0, body().fill(8).sequence(base).number32(bits).fill(4 * words + 4));
  }
  static Bytes heartbeat(std::int64_t first, std::int64_t last) {
    return submessage(0x07, 0, body().fill(8).sequence(first).sequence(last).number32(1));
  }
  static Bytes statistics() { return submessage(0x80, 0, body().fill(56)); }
  static Bytes time() { return submessage(0x09, 0, body().fill(8)); }
  static Bytes destination() { return submessage(0x0e, 0, body().fill(12)); }
};

TEST_P(DatagramFilter, PassesWhatTheStandardDescribes) {
  EXPECT_TRUE(passes(data(0x04, 8)));
  EXPECT_TRUE(passes(data(0x08, 20)));
  EXPECT_TRUE(passes(data(0x00, 0)));
  EXPECT_TRUE(passes(data(0x04, 8, 1, 24)));
  EXPECT_TRUE(passes(heartbeat(1, 0)));
  EXPECT_TRUE(passes(heartbeat(5, 10)));
  EXPECT_TRUE(passes(acknowledgement(0, 0, 0)));
  EXPECT_TRUE(passes(acknowledgement(9, 256, 8)));
  EXPECT_TRUE(passes(gap(1, 1, 3, 1)));
  EXPECT_TRUE(passes(gap(1, 1000, 0, 0)));
  EXPECT_TRUE(passes(time()));
  EXPECT_TRUE(passes(submessage(0x09, 0x02, body())));  // no time
  EXPECT_TRUE(passes(destination()));
  EXPECT_TRUE(passes(submessage(0x0c, 0, body().fill(20))));
  EXPECT_TRUE(passes(submessage(0x01, 0, body())));
  EXPECT_TRUE(
      passes(submessage(0x12, 0, body().fill(8).sequence(1).number32(1).number32(32).fill(8))));
  EXPECT_TRUE(passes(submessage(0x13, 0, body().fill(8).sequence(1).fill(8))));
  EXPECT_TRUE(passes(fragment(1, 1, 100, 250, 100)));
  EXPECT_TRUE(passes(fragment(3, 1, 100, 250, 50)));
  EXPECT_TRUE(passes(fragment(1, 10, 1'344, 100'000, 13'440))) << "as CycloneDDS sends them";
  const Bytes several = message({destination(), time(), data(0x04, 8), heartbeat(1, 1)});
  EXPECT_EQ(read(several), several.size());
}

TEST_P(DatagramFilter, CutsStatisticsOffAndTakesNothingBehindThem) {
  const Bytes sample = message({time(), data(0x04, 8)});
  const Bytes counted = message({time(), data(0x04, 8), statistics()});
  EXPECT_EQ(read(counted), sample.size());
  for (int more = 1; more <= 8; ++more) {
    Bytes longer = counted;
    longer.resize(counted.size() + static_cast<std::size_t>(more), 0);
    EXPECT_EQ(read(longer), 0U) << more << " bytes behind them";
  }
  EXPECT_EQ(read(message({statistics(), data(0x04, 8)})), 0U);
  EXPECT_EQ(read(message({statistics()})), 0U);

  // Other vendors have other things of that number.
  const Bytes of_others = message({statistics(), data(0x04, 8)}, 0x10);
  EXPECT_EQ(read(of_others), of_others.size());
}

TEST_P(DatagramFilter, PassesNoMessageThatEndsTooSoonOrTooLate) {
  const std::vector<Bytes> parts{destination(),   time(),           data(0x06, 0),
                                 heartbeat(1, 4), gap(1, 2, 40, 2), acknowledgement(1, 33, 2)};
  // Parameters of the sample: one of 4 bytes, and the end.
  BodyWriter fields = body();
  fields.number16(0).number16(16).fill(8).sequence(1);
  fields.number16(0x71).number16(4).fill(4).number16(1).number16(0).fill(8);
  const Bytes whole =
      message({parts[0], parts[1], submessage(0x15, 0x06, fields), parts[3], parts[4], parts[5]});
  ASSERT_EQ(read(whole), whole.size());
  std::vector<std::size_t> ends{20};
  for (std::size_t begin = 20; begin < whole.size();) {
    const std::size_t length = GetParam() ? whole[begin + 2] + 256U * whole[begin + 3]
                                          : 256U * whole[begin + 2] + whole[begin + 3];
    ends.push_back(begin += 4 + length);
  }
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    const bool is_whole = size > 20 && std::ranges::find(ends, size) != ends.end();
    EXPECT_EQ(read(part), is_whole ? size : 0U) << size;
  }
  for (std::size_t more = 1; more < 4; ++more) {
    Bytes longer = whole;
    longer.resize(whole.size() + more, 0);
    EXPECT_EQ(read(longer), 0U) << more;
  }
}

TEST_P(DatagramFilter, PassesNoValuesThatFastDdsCannotFollow) {
  EXPECT_FALSE(passes(data(0x04, 0))) << "no payload";
  EXPECT_FALSE(passes(data(0x04, 3)));
  EXPECT_FALSE(passes(data(0x0c, 8))) << "both a sample and a key";
  EXPECT_FALSE(passes(data(0x04, 8, 0))) << "number 0";
  EXPECT_FALSE(passes(data(0x04, 8, -5)));
  EXPECT_FALSE(passes(submessage(
      0x15, 0x04, body().number16(0).number16(16).number32(7).number32(0).sequence(1).fill(8))))
      << "no writer";
  EXPECT_FALSE(
      passes(submessage(0x15, 0x04, body().number16(0).number16(12).fill(8).sequence(1).fill(8))))
      << "parameters within the fields";
  EXPECT_FALSE(passes(
      submessage(0x15, 0x04, body().number16(0).number16(65'000).fill(8).sequence(1).fill(8))))
      << "parameters behind the end";
  const auto with_parameter = [](unsigned length, bool ends) {
    BodyWriter fields = body();
    fields.number16(0).number16(16).fill(8).sequence(1).number16(0x71).number16(length).fill(4);
    if (ends) fields.number16(1).number16(0);
    return submessage(0x15, 0x02, fields);
  };
  EXPECT_TRUE(passes(with_parameter(4, true)));
  EXPECT_FALSE(passes(with_parameter(4, false))) << "no end of the parameters";
  EXPECT_FALSE(passes(with_parameter(3, true)));
  EXPECT_FALSE(passes(with_parameter(40, true)));

  const auto with_status = [](int status, int writer_kind) {
    BodyWriter fields = body();
    fields.number16(0).number16(16).number32(7).octets({0, 0, 3, writer_kind}).sequence(1);
    fields.number16(0x71).number16(4).octets({0, 0, 0, status}).number16(1).number16(0);
    return submessage(0x15, 0x02, fields);
  };
  EXPECT_TRUE(passes(with_status(3, 0x02)));
  EXPECT_TRUE(passes(with_status(2, 0x02)));
  EXPECT_FALSE(passes(with_status(1, 0x02))) << "a key is taken back alone";
  EXPECT_TRUE(passes(with_status(1, 0xc2))) << "of discovery";

  EXPECT_FALSE(passes(heartbeat(0, 3)));
  EXPECT_FALSE(passes(heartbeat(5, 3)));
  EXPECT_FALSE(passes(acknowledgement(-1, 0, 0)));
  EXPECT_FALSE(passes(acknowledgement(1, 257, 9)));
  EXPECT_FALSE(passes(acknowledgement(1, 64, 0))) << "fewer bits than it says";
  EXPECT_FALSE(passes(gap(0, 1, 0, 0)));
  EXPECT_FALSE(passes(gap(2, 1, 0, 0)));
  EXPECT_TRUE(passes(gap(1, 1 + 65'536, 0, 0)));
  EXPECT_FALSE(passes(gap(1, 2 + 65'536, 0, 0))) << "Fast DDS counts through it";
  EXPECT_EQ(read(message({gap(1, 40'000, 0, 0), gap(1, 40'000, 0, 0)})), 0U);
  EXPECT_FALSE(passes(gap(1, std::int64_t{1} << 62, 0, 0)));
  EXPECT_FALSE(passes(submessage(0x0c, 0, body().fill(16))));
  EXPECT_FALSE(
      passes(submessage(0x12, 0, body().fill(8).sequence(1).number32(0).number32(0).fill(4))));

  Bytes of_a_key = fragment(1, 1, 100, 250, 100);
  of_a_key[1] |= 0x04;
  EXPECT_FALSE(passes(of_a_key));
  EXPECT_FALSE(passes(fragment(0, 1, 100, 250, 100)));
  EXPECT_FALSE(passes(fragment(2, 3, 100, 250, 300))) << "more than there are";
  EXPECT_FALSE(passes(fragment(1, 17, 100, 25'000, 1'700)));
  EXPECT_FALSE(passes(fragment(1, 1, 4, 250, 4))) << "no room for what is missing";
  EXPECT_FALSE(passes(fragment(1, 1, 100, 1'002, 100)));
  EXPECT_FALSE(passes(fragment(1, 1, 8, 1U << 30, 8)));
  EXPECT_FALSE(passes(fragment(1, 1, 0, 250, 100)));
  EXPECT_FALSE(passes(fragment(1, 1, 100, 250, 96))) << "shorter than it says";
  EXPECT_FALSE(passes(fragment(4, 1, 100, 250, 100))) << "behind the end";
  EXPECT_FALSE(passes(fragment(0xffff'ffff, 1, 65'535, 250, 100)));
  EXPECT_FALSE(passes(fragment(1, 1, 100, 0xffff'ffff, 100))) << "4 GB";
}

TEST_P(DatagramFilter, LooksIntoWhatFindsAndAuthenticatesParticipants) {
  const auto data_of = [](int writer_high, int writer_low, const BodyWriter& payload) {
    BodyWriter fields = body();
    fields.number16(0).number16(16).octets({0, 1, 0, 0xc7, 0, writer_high,
                                            writer_low == 0xc3 ? 1 : writer_low / 256,
                                            writer_low % 256});
    fields.sequence(1);
    BodyWriter whole = body();
    for (const Bytes& bytes : {fields.bytes(), payload.bytes()}) {
      for (const std::uint8_t octet : bytes) whole.octets({octet});
    }
    return submessage(0x15, 0x04, whole);
  };
  const auto text = [](BodyWriter& writer, std::uint32_t said) { writer.number32(said).fill(8); };
  const auto parameter_of = [&](int writer_high, int writer_low, unsigned parameter, auto write) {
    BodyWriter value = body();
    write(value);
    BodyWriter payload = body();
    payload.octets({0, GetParam() ? 3 : 2, 0, 0}).number16(parameter);
    payload.number16(static_cast<unsigned>(value.bytes().size()));
    for (const std::uint8_t octet : value.bytes()) payload.octets({octet});
    return data_of(writer_high, writer_low, payload.number16(1).number16(0));
  };
  const auto announcement = [&](unsigned parameter, auto write) {
    return parameter_of(1, 0xc2, parameter, write);
  };
  const auto properties = [&](BodyWriter& writer, std::uint32_t count, std::uint32_t length) {
    writer.number32(count);
    text(writer, 8);
    text(writer, length);
  };
  const auto token = [&](std::uint32_t name, std::uint32_t count, std::uint32_t length) {
    return [=](BodyWriter& writer) {
      text(writer, name);
      properties(writer, count, length);
      properties(writer, 1, 5);
    };
  };
  for (const unsigned parameter : {0x1001U, 0x1002U}) {
    EXPECT_TRUE(passes(announcement(parameter, token(8, 1, 6))));
    EXPECT_FALSE(passes(announcement(parameter, token(0xffff'fffe, 1, 6)))) << "a text of 4 GB";
    EXPECT_FALSE(passes(announcement(parameter, token(8, 0x7fff'ffff, 6)))) << "so many properties";
    EXPECT_FALSE(passes(announcement(parameter, token(8, 1, 0xffff'fff0))));
  }
  EXPECT_TRUE(passes(announcement(0x59, [&](BodyWriter& w) { properties(w, 1, 8); })));
  EXPECT_FALSE(passes(announcement(0x59, [&](BodyWriter& w) { properties(w, 2, 8); })));
  EXPECT_TRUE(passes(announcement(0x62, token(0xffff'fffe, 1, 6))))
      << "of other kinds the library takes care";

  const auto number = [](std::uint32_t value) {
    return [=](BodyWriter& writer) { writer.number32(value).fill(4); };
  };
  EXPECT_TRUE(passes(announcement(0x02, number(1))));
  EXPECT_FALSE(passes(announcement(0x02, number(0)))) << "it has ended before it began";
  EXPECT_FALSE(passes(announcement(0x02, number(0xffff'ffff))));
  const auto guid = [](int first, int last) {
    return [=](BodyWriter& writer) {
      writer.octets({first, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, last});
    };
  };
  EXPECT_TRUE(passes(announcement(0x50, guid(1, 0xc1))));
  EXPECT_FALSE(passes(announcement(0x50, guid(0, 0xc1))));
  EXPECT_FALSE(passes(announcement(0x50, guid(1, 0xc2))));

  const auto endpoint = [&](unsigned parameter, auto write) {
    return parameter_of(0, 0x3c2, parameter, write);
  };
  const auto texts = [&](std::uint32_t count, std::uint32_t length) {
    return [=](BodyWriter& writer) {
      writer.number32(count);
      text(writer, length);
    };
  };
  EXPECT_TRUE(passes(endpoint(0x29, texts(1, 8))));
  EXPECT_FALSE(passes(endpoint(0x29, texts(0xffff'ffff, 8))));
  EXPECT_FALSE(passes(endpoint(0x29, texts(2, 0xffff'ff00))));
  EXPECT_FALSE(passes(endpoint(0x73, texts(0xffff'ffff, 8))));
  EXPECT_FALSE(passes(endpoint(0x8006, texts(0xffff'ffff, 8))));
  EXPECT_TRUE(passes(endpoint(0x73, [](BodyWriter& w) { w.number32(1).number16(0).number16(0); })));
  EXPECT_TRUE(passes(endpoint(0x05, [](BodyWriter& w) {
    w.number32(3).octets({'a', 'b', 0, 0});
  })));
  EXPECT_FALSE(passes(endpoint(0x05, [](BodyWriter& w) {
    w.number32(4).octets({'a', 'b', 'c', 'd'});
  })));
  EXPECT_FALSE(passes(endpoint(0x05, number(0xffff'ffff))));
  EXPECT_FALSE(passes(endpoint(0x06, number(0xffff'ffff))));
  EXPECT_FALSE(passes(endpoint(0x69, number(0)))) << "a description of its type";
  EXPECT_FALSE(passes(endpoint(0x5a, guid(0, 0xc7))));

  const auto handshake = [&](std::uint32_t holders, std::uint32_t name) {
    BodyWriter payload = body();
    payload.octets({0, GetParam() ? 1 : 0, 0, 0}).fill(96);
    text(payload, 8);
    payload.number32(holders);
    token(name, 1, 6)(payload);
    return data_of(2, 0xc3, payload);
  };
  EXPECT_TRUE(passes(handshake(1, 8)));
  EXPECT_FALSE(passes(handshake(2, 8)));
  EXPECT_FALSE(passes(handshake(0x1000'0000, 8)));
  EXPECT_FALSE(passes(handshake(1, 0xffff'fffe)));
}

TEST_P(DatagramFilter, KnowsFragments) {
  const auto has = [](const Bytes& bytes) {
    return has_fragments(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  };
  EXPECT_TRUE(has(message({time(), fragment(1, 1, 100, 250, 100)})));
  EXPECT_FALSE(has(message({time(), data(0x04, 8), heartbeat(1, 1)})));
}

TEST_P(DatagramFilter, HoldsASecuredParticipantToMore) {
  const Bytes encrypted = message({submessage(0x33, 0, body().fill(20)),
                                   submessage(0x30, 0, body().octets({0, 0, 0, 28}).fill(28)),
                                   submessage(0x34, 0, body().fill(20)), statistics()});
  EXPECT_EQ(read(encrypted, true), encrypted.size() - 60);
  Bytes longer = encrypted;
  longer.push_back(0);
  EXPECT_EQ(read(longer, true), 0U);
  const Bytes too_long = message({submessage(0x33, 0, body().fill(20)),
                                  submessage(0x30, 0, body().octets({0, 0, 0, 29}).fill(28))});
  EXPECT_EQ(read(too_long, true), 0U);
  const Bytes clear = message({heartbeat(1, 1)});
  EXPECT_EQ(read(clear, false), clear.size());
  EXPECT_EQ(read(clear, true), 0U);
}

TEST(DatagramFilterOfNoRtps, PassesNothing) {
  EXPECT_EQ(bytes_to_read(nullptr, 0, false), 0U);
  const Bytes other(64, 'x');
  EXPECT_EQ(bytes_to_read(other.data(), 64, false), 0U);
}

INSTANTIATE_TEST_SUITE_P(Both, DatagramFilter, testing::Bool(), [](const auto& order) {
  return order.param ? "little_endian" : "big_endian";
});

}  // namespace
}  // namespace cordis::dds
