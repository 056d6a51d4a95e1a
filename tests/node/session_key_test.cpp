// tests/node/session_key_test.cpp
#include "node/session_key.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace cordis::node {
namespace {

namespace fs = std::filesystem;

const SessionKey kKey("000102030405060708090a0b0c0d0e0f");

msg::ControlCommand some_command() {
  msg::ControlCommand command;
  command.command_id(7);
  command.sender("me");
  command.target("sim_node");
  command.verb(msg::VERB_SET);
  command.argument("{finger.mass_kg: 2}");
  return command;
}

std::string text_of(const msg::AuthenticationCode& code) {
  std::string text;
  for (const std::uint8_t byte : code) text += fmt::format("{:02x}", byte);
  return text;
}

class SessionKeyFile : public ::testing::Test {
 protected:
  SessionKeyFile() {
    char name[] = "/tmp/cordis-test-XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~SessionKeyFile() override { fs::remove_all(folder_); }

  fs::path written(const std::string& text, mode_t mode = 0600) const {
    const fs::path file = folder_ / "key";
    std::ofstream(file) << text;
    chmod(file.c_str(), mode);
    return file;
  }
  static std::string why_not(const fs::path& file) {
    try {
      static_cast<void>(read_key_file(file));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST(SessionKey, HasTheCodeThatAnotherProgramComputes) {
  // Python: hmac.new(digits, b"14:cordis command,7:plucked,3:sim,13:1234567890123,1:7,2:me,"
  // b"8:sim_node,1:5,19:{finger.mass_kg: 2},", "sha256")
  EXPECT_EQ(text_of(kKey.code_of(some_command(), "plucked", "sim", 1234567890123)),
            "1e41f55aa76a7eee0fe9d6b475b772a1f2515a1ea30ec17e417a5f8f79529c0a");
}

TEST(SessionKey, HasAnotherCodeForWhateverIsChanged) {
  const std::string code = text_of(kKey.code_of(some_command(), "s", "n", 1));
  const auto changed = [](auto change) {
    msg::ControlCommand command = some_command();
    change(command);
    return text_of(kKey.code_of(command, "s", "n", 1));
  };
  EXPECT_NE(changed([](auto& command) { command.command_id(8); }), code);
  EXPECT_NE(changed([](auto& command) { command.sender("m"); }), code);
  EXPECT_NE(changed([](auto& command) { command.target("*"); }), code);
  EXPECT_NE(changed([](auto& command) { command.verb(msg::VERB_LOAD); }), code);
  EXPECT_NE(changed([](auto& command) { command.argument(""); }), code);
  EXPECT_NE(text_of(kKey.code_of(some_command(), "s", "n", 2)), code);
  EXPECT_NE(text_of(kKey.code_of(some_command(), "s", "m", 1)), code);
  EXPECT_NE(text_of(kKey.code_of(some_command(), "sn", "", 1)), code);
  EXPECT_NE(text_of(SessionKey::random().code_of(some_command(), "s", "n", 1)), code);
  EXPECT_EQ(changed([](auto& command) { command.authenticators().resize(3); }), code);
}

TEST(SessionKey, IsNewEachTime) {
  EXPECT_NE(SessionKey::random(), SessionKey::random());
  EXPECT_THROW(SessionKey(""), std::invalid_argument);
  EXPECT_THROW(SessionKey(std::string(32, 'g')), std::invalid_argument);
  EXPECT_THROW(SessionKey(std::string(33, '0')), std::invalid_argument);
}

TEST_F(SessionKeyFile, IsReadAsItWasWrittenAndIsForOneUser) {
  const fs::path file = folder_ / "key";
  for (int i = 0; i < 3; ++i) {
    const SessionKey key = SessionKey::random();
    write_key_file(file, key);
    EXPECT_EQ(read_key_file(file), key);
    struct stat found {};
    ASSERT_EQ(stat(file.c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 07777, static_cast<mode_t>(0600));
  }
}

TEST_F(SessionKeyFile, ThatOthersMayReadIsRefused) {
  for (const mode_t mode : {0644, 0640, 0604, 0620, 0601})
    EXPECT_NE(why_not(written(kKey.digits(), mode)).find("chmod 600"), std::string::npos) << mode;
  EXPECT_EQ(why_not(written(kKey.digits(), 0400)), "");
}

TEST_F(SessionKeyFile, ThatHasNoKeyIsRefusedWithoutItsText) {
  for (const std::string& text : {std::string(), std::string("swordfish"), kKey.digits() + "0",
                                  kKey.digits() + "\n\n", std::string(1 << 20, 'a')}) {
    const std::string reason = why_not(written(text));
    EXPECT_NE(reason.find("has no key"), std::string::npos) << reason;
    EXPECT_EQ(reason.find("swordfish"), std::string::npos) << reason;
  }
  EXPECT_NE(why_not(folder_ / "none").find("cannot be read"), std::string::npos);
  EXPECT_NE(why_not(folder_).find("is no file"), std::string::npos);
  const fs::path fifo = folder_ / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_NE(why_not(fifo).find("is no file"), std::string::npos);
}

}  // namespace
}  // namespace cordis::node
