// tests/record/message_decoder_test.cpp
#include "record_node/idl/message_decoder.h"

#include <string>
#include <vector>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <gtest/gtest.h>

#include "idl/control.h"
#include "idl/scene.h"
#include "idl/schema_text.h"
#include "record_node/idl/idl_parser.h"

namespace cordis::record {
namespace {

/// Writes fields in a line.
class LineSink final : public FieldSink {
 public:
  std::string line;
  void begin_struct() override { line += "{"; }
  void member(std::string_view name) override { line += std::string(name) + ":"; }
  void end_struct() override { line += "}"; }
  void begin_list(std::size_t count) override { line += "[" + std::to_string(count) + ":"; }
  void end_list() override { line += "]"; }
  void truth(bool value) override { line += value ? "true " : "false "; }
  void integer(std::int64_t value) override { line += std::to_string(value) + " "; }
  void natural(std::uint64_t value) override { line += std::to_string(value) + " "; }
  void real(double value, bool) override { line += std::to_string(value) + " "; }
  void text(std::string_view value) override { line += "'" + std::string(value) + "' "; }
  void word(std::string_view word, std::int64_t) override { line += std::string(word) + " "; }
};

/// The message as the generated class and Fast CDR write it.
template <class Message>
std::vector<std::uint8_t> written(const Message& message,
                                  eprosima::fastcdr::Cdr::Endianness order) {
  eprosima::fastcdr::FastBuffer buffer;
  eprosima::fastcdr::Cdr cdr(buffer, order, eprosima::fastcdr::Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  message.serialize(cdr);
  const auto* begin = reinterpret_cast<const std::uint8_t*>(buffer.getBuffer());
  return {begin, begin + cdr.getSerializedDataLength()};
}

MessageTypePtr contract_type(const std::string& name) {
  const std::string whole = "cordis::msg::" + name;
  return parse_idl(std::string(msg::schema_text_of(whole)), whole).at(whole);
}

std::string line_of(const MessageType& type, const std::vector<std::uint8_t>& message) {
  LineSink sink;
  decode(type, message, sink);
  return sink.line;
}

msg::SceneEvents some_events() {
  msg::LinkEvent event;
  event.step(5'000'000'000);
  event.link(7);
  event.quantity(msg::QUANTITY_FORCE);
  event.value(-2.5);
  msg::SceneEvents events;
  events.epoch(1);
  events.event({event, event});
  return events;
}

constexpr const char* kEvent =
    "{step:5000000000 link:7 mat_a:0 mat_b:0 state_machine:0 from_state:0 to_state:0 "
    "quantity:QUANTITY_FORCE value:-2.500000 energy_j:0.000000 }";

TEST(MessageDecoder, ReadsWhatFastCdrWritesInEitherByteOrder) {
  const std::string expected =
      std::string("{epoch:1 version:0 batch:0 lost:0 event:[2:") + kEvent + kEvent + "]}";
  for (const auto order :
       {eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS, eprosima::fastcdr::Cdr::BIG_ENDIANNESS})
    EXPECT_EQ(line_of(*contract_type("SceneEvents"), written(some_events(), order)), expected);
}

TEST(MessageDecoder, ReadsTextsEnumsAndTruths) {
  msg::ControlReply reply;
  reply.command_id(9);
  reply.sender("cordis");
  reply.node("");
  reply.accepted(true);
  reply.text("paused at step 3");
  EXPECT_EQ(line_of(*contract_type("ControlReply"),
                    written(reply, eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS)),
            "{command_id:9 sender:'cordis' node:'' accepted:true text:'paused at step 3' }");
}

TEST(MessageDecoder, RefusesEveryMessageThatIsCutShort) {
  const auto whole = written(some_events(), eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS);
  const MessageTypePtr type = contract_type("SceneEvents");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    LineSink sink;
    EXPECT_THROW(decode(*type, std::span(whole).first(size), sink), DecodeError) << size;
  }
}

TEST(MessageDecoder, RefusesALengthBeyondTheMessage) {
  const MessageTypes types = parse_idl("struct S { sequence<octet> a; string b; };", "test");
  LineSink sink;
  const std::vector<std::uint8_t> message{0, 1, 0, 0, 0xff, 0xff, 0xff, 0x7f, 1, 2, 3};
  EXPECT_THROW(decode(*types.at("S"), message, sink), DecodeError);
}

TEST(IdlParser, ReadsAllMessagesOfTheContract) {
  for (const msg::SchemaText& schema : msg::schema_texts())
    EXPECT_TRUE(parse_idl(std::string(schema.text), "contract").contains(std::string(schema.type)))
        << schema.type;
}

TEST(IdlParser, SaysWhereATextIsNotUnderstood) {
  const auto refusal = [](const std::string& text) {
    try {
      parse_idl(text, "a.idl");
    } catch (const IdlError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(refusal("module m {\nstruct S { Unknown x; };\n};"),
            "a.idl:2: no type is named 'Unknown'");
  EXPECT_EQ(refusal("struct S { long x }"), "a.idl:1: expected ';', got '}'");
  EXPECT_NE(refusal("union U switch (long) { case 1: long x; };"), "nothing");
  EXPECT_NE(refusal("struct S { @optional long x; };"), "nothing");
  EXPECT_NE(refusal("module m {"), "nothing");
  EXPECT_NE(refusal("struct S {"), "nothing");
  EXPECT_NE(refusal("struct S { long x[0]; };"), "nothing");
  EXPECT_NE(refusal("struct S { };"), "nothing");
}

TEST(IdlParser, RefusesWhatIsNestedTooDeep) {
  const auto repeated = [](const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
  };
  const auto nested = [&repeated](int depth) {
    return "struct S { " + repeated("sequence<", depth) + "long" + repeated(">", depth) + " x; };";
  };
  EXPECT_NO_THROW(parse_idl(nested(60), "test"));
  EXPECT_THROW(parse_idl(nested(100'000), "test"), IdlError);
  EXPECT_THROW(parse_idl(repeated("sequence<", 100'000), "test"), IdlError);
  EXPECT_THROW(parse_idl(repeated("module m {", 100'000), "test"), IdlError);
  EXPECT_THROW(parse_idl("struct S { long x" + repeated("[1]", 100'000) + "; };", "test"),
               IdlError);
  std::string chain = "typedef sequence<long> T0;";
  for (int i = 1; i < 1000; ++i)
    chain += "typedef sequence<T" + std::to_string(i - 1) + "> T" + std::to_string(i) + ";";
  EXPECT_THROW(parse_idl(chain, "test"), IdlError);
}

TEST(IdlParser, FollowsTypedefsConstantsAndDimensions) {
  const MessageTypes types = parse_idl(
      "module a { const long N = 2; typedef double Pair[N]; module b {\n"
      "@final struct S { @key long k; Pair p[3]; sequence<a::Pair, 4> q; }; }; };",
      "test");
  const MessageType& type = *types.at("a::b::S");
  ASSERT_EQ(type.members.size(), 3u);
  EXPECT_TRUE(type.members[0].is_key);
  EXPECT_EQ(type.members[1].type->count, 3u);
  EXPECT_EQ(type.members[1].type->element->count, 2u);
  EXPECT_EQ(type.members[2].type->element->count, 2u);
}

}  // namespace
}  // namespace cordis::record
