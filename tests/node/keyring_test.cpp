// tests/node/keyring_test.cpp -- the keys of a secured session.
#include "node/security/keyring.h"

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "idl/topics.h"
#include "node/security/certificate.h"
#include "node/security/identity.h"
#include "node/session_key.h"

namespace cordis::node {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

std::string whole_file(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

mode_t mode_of(const fs::path& path) {
  struct stat found {};
  return stat(path.c_str(), &found) == 0 ? found.st_mode & 07777 : 0;
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

class Keyring : public ::testing::Test {
 protected:
  Keyring() {
    char name[] = "/tmp/cordis-test-XXXXXX";
    folder_ = mkdtemp(name);
    ring_ = folder_ / "keys";
    make_keyring(ring_, {});
  }
  ~Keyring() override { fs::remove_all(folder_); }

  std::string why_no_identity(const fs::path& folder, Role role) const {
    return refusal([&] { static_cast<void>(identity_in(folder, {role}, "")); });
  }

  fs::path folder_;
  fs::path ring_;
};

TEST_F(Keyring, HasAKeyForEachRoleAndAViewThatDoesNotCommand) {
  std::string listed;
  for (const KeyEntry& key : keys_in(ring_)) listed += key.name + "=" + key.role + " ";

  EXPECT_EQ(listed,
            "controller=controller device=device launcher=launcher player=player recorder=recorder "
            "sim=sim "
            "view=view ");
  EXPECT_EQ(identity_in(ring_, {Role::kViewThatCommands, Role::kView}, "view").role, Role::kView);
}

TEST_F(Keyring, LetsViewsCommandOnlyWhereThatIsGranted) {
  KeyOptions granting;
  granting.view_commands = true;
  make_keyring(folder_ / "granted", granting);

  EXPECT_EQ(identity_in(folder_ / "granted", {Role::kViewThatCommands, Role::kView}, "").role,
            Role::kViewThatCommands);
  for (const std::string& topic : {msg::TOPIC_POSITIONS, msg::TOPIC_FORCES}) {
    EXPECT_THAT(topics_of(Role::kView).written, Not(::testing::Contains(topic)));
    EXPECT_THAT(topics_of(Role::kViewThatCommands).written, Not(::testing::Contains(topic)));
    EXPECT_THAT(topics_of(Role::kController).written, Not(::testing::Contains(topic)));
  }
  EXPECT_THAT(topics_of(Role::kView).written, Not(::testing::Contains(msg::TOPIC_COMMAND)));
  EXPECT_THAT(topics_of(Role::kView).written, Not(::testing::Contains(msg::TOPIC_POINTER_TARGET)));
}

TEST_F(Keyring, KeepsWhatIsPrivateFromOthers) {
  EXPECT_EQ(mode_of(ring_), 0700u);
  int private_files = 0;
  for (const auto& file : fs::directory_iterator(ring_)) {
    const std::string name = file.path().filename().string();
    const bool is_private = name.ends_with(".key.pem") || name == "command.key";
    private_files += is_private ? 1 : 0;
    EXPECT_EQ(mode_of(file.path()), is_private ? 0600u : 0644u) << name;
    EXPECT_EQ(whole_file(file.path()).find("PRIVATE KEY") != std::string::npos,
              name.ends_with(".key.pem"))
        << name;
  }
  EXPECT_EQ(private_files, 10);  // two authorities, seven roles, commands
}

TEST_F(Keyring, IsNeverOverwritten) {
  const std::string before = whole_file(KeyFiles(ring_, "sim").key);

  EXPECT_THAT(refusal([&] { make_keyring(ring_, {}); }), HasSubstr("never overwritten"));
  EXPECT_EQ(whole_file(KeyFiles(ring_, "sim").key), before);
}

TEST_F(Keyring, HandsOutAKeyAndNothingThatMakesKeys) {
  const fs::path handed = folder_ / "remote";
  add_key(ring_, "remote", Role::kController, handed, {});

  std::set<std::string> names;
  for (const auto& file : fs::directory_iterator(handed))
    names.insert(file.path().filename().string());
  EXPECT_THAT(names, ::testing::ElementsAre("command.key", "governance.p7s", "identity_ca.cert.pem",
                                            "permissions_ca.cert.pem", "remote.cert.pem",
                                            "remote.key.pem", "remote.permissions.p7s"));
  EXPECT_EQ(mode_of(handed), 0700u);
  EXPECT_EQ(identity_in(handed, {Role::kController}, "").role, Role::kController);
  EXPECT_EQ(read_key_file(SharedKeyFiles(handed).command_key),
            read_key_file(SharedKeyFiles(ring_).command_key));
  EXPECT_THAT(refusal([&] { add_key(handed, "more", Role::kSim, folder_ / "third", {}); }),
              HasSubstr("makes no keys"));
}

TEST_F(Keyring, AddsToAFolderOfItsOwnKeysAlone) {
  const fs::path handed = folder_ / "remote";
  add_key(ring_, "hand", Role::kDevice, handed, {});
  add_key(ring_, "screen", Role::kView, handed, {});
  make_keyring(folder_ / "other", {});

  EXPECT_EQ(keys_in(handed).size(), 2u);
  EXPECT_THAT(refusal([&] { add_key(ring_, "hand", Role::kSim, handed, {}); }),
              HasSubstr("already has a key named 'hand'"));
  EXPECT_THAT(refusal([&] { add_key(folder_ / "other", "x", Role::kSim, handed, {}); }),
              HasSubstr("keys of another keyring"));
  EXPECT_THAT(refusal([&] { add_key(ring_, "identity_ca", Role::kSim, handed, {}); }),
              HasSubstr("the name of a key"));
}

TEST_F(Keyring, GivesAProcessTheKeyOfItsNameThenOfItsRoleThenTheOnlyOne) {
  add_key(ring_, "left_hand", Role::kDevice, ring_, {});
  const fs::path handed = folder_ / "remote";
  add_key(ring_, "hand", Role::kDevice, handed, {});

  const auto certificate = [](const fs::path& folder, Role role, const std::string& name) {
    return fs::path(identity_in(folder, {role}, name).security.certificate).filename().string();
  };
  EXPECT_EQ(certificate(ring_, Role::kDevice, "left_hand"), "left_hand.cert.pem");
  EXPECT_EQ(certificate(ring_, Role::kDevice, "right_hand"), "device.cert.pem");
  EXPECT_EQ(certificate(handed, Role::kLauncher, ""), "hand.cert.pem");
  add_key(ring_, "screen", Role::kView, handed, {});
  EXPECT_THAT(why_no_identity(handed, Role::kLauncher), HasSubstr("has no key of a launcher"));
}

TEST_F(Keyring, RefusesFilesThatOthersCanRead) {
  chmod(KeyFiles(ring_, "sim").key.c_str(), 0640);
  EXPECT_EQ(why_no_identity(ring_, Role::kSim), "the key file " +
                                                    KeyFiles(ring_, "sim").key.string() +
                                                    " is open to other users: chmod 600 closes it");
  chmod(ring_.c_str(), 0750);
  EXPECT_THAT(why_no_identity(ring_, Role::kDevice), HasSubstr("chmod 700 closes it"));
}

TEST_F(Keyring, NamesTheFileThatIsWrong) {
  const fs::path certificate = KeyFiles(ring_, "sim").certificate;
  make_keyring(folder_ / "other", {});

  fs::remove(SharedKeyFiles(ring_).governance);
  EXPECT_THAT(why_no_identity(ring_, Role::kDevice),
              HasSubstr(SharedKeyFiles(ring_).governance.string() + " cannot be read"));

  fs::copy_file(KeyFiles(folder_ / "other", "sim").certificate, certificate,
                fs::copy_options::overwrite_existing);
  EXPECT_THAT(why_no_identity(ring_, Role::kSim), HasSubstr("does not belong to"));
  const fs::path key = KeyFiles(ring_, "sim").key;
  fs::copy_file(KeyFiles(folder_ / "other", "sim").key, key, fs::copy_options::overwrite_existing);
  EXPECT_EQ(
      why_no_identity(ring_, Role::kSim),
      "the key file " + certificate.string() + " is not signed by the authority of its folder");
  std::ofstream(certificate) << "none";
  EXPECT_THAT(why_no_identity(ring_, Role::kSim), HasSubstr("has no certificate"));
}

TEST_F(Keyring, RefusesAKeyThatHasExpiredOrIsNotYetValid) {
  const auto remade = [&](std::time_t from, std::time_t until) {
    const Certificate authority = Certificate::read(KeyFiles(ring_, "identity_ca").certificate,
                                                    KeyFiles(ring_, "identity_ca").key);
    const Certificate certificate =
        Certificate::make("sim", "sim", Certificate::Use::kParticipant, {from, until}, &authority);
    std::ofstream(KeyFiles(ring_, "sim").certificate) << certificate.certificate_pem();
    std::ofstream(KeyFiles(ring_, "sim").key) << certificate.key_pem();
    return why_no_identity(ring_, Role::kSim);
  };
  const std::time_t now = std::time(nullptr);

  EXPECT_THAT(remade(0, 86400 * 365), HasSubstr("sim.cert.pem has expired on 1971-01-01"));
  EXPECT_THAT(remade(now + 86400, now + 2 * 86400), HasSubstr("is the clock of this host right?"));
}

TEST_F(Keyring, LetsNobodySignPermissionsWithAKeyOfAParticipant) {
  const KeyFiles files(ring_, "view");
  const Certificate view = Certificate::read(files.certificate, files.key);
  const Certificate identity_authority = Certificate::read(
      KeyFiles(ring_, "identity_ca").certificate, KeyFiles(ring_, "identity_ca").key);
  const Certificate permitting = Certificate::read(SharedKeyFiles(ring_).permissions_authority, {});
  const std::string wanted =
      permissions_text(Role::kSim, view.subject(), {}, {view.from(), view.until()});

  EXPECT_TRUE(permitting.has_signed_document(whole_file(files.permissions)));
  EXPECT_FALSE(permitting.has_signed_document(view.signed_text(wanted)));
  EXPECT_FALSE(permitting.has_signed_document(identity_authority.signed_text(wanted)));
  EXPECT_FALSE(identity_authority.has_signed_document(view.signed_text(wanted)));
  std::string changed = whole_file(files.permissions);
  changed.replace(changed.find(msg::TOPIC_REPLY), msg::TOPIC_REPLY.size(), "gesture/force");
  EXPECT_FALSE(permitting.has_signed_document(changed));
}

TEST_F(Keyring, RefusesPermissionsOfAnotherKeyOfTheSameName) {
  KeyOptions limited;
  limited.sessions = {"bow"};
  add_key(ring_, "device", Role::kDevice, folder_ / "handed", limited);
  const KeyFiles mine(ring_, "device");
  const KeyFiles theirs(folder_ / "handed", "device");
  EXPECT_EQ(why_no_identity(folder_ / "handed", Role::kDevice), "");

  fs::copy_file(mine.permissions, theirs.permissions, fs::copy_options::overwrite_existing);

  EXPECT_THAT(why_no_identity(folder_ / "handed", Role::kDevice),
              HasSubstr("device.permissions.p7s is for another key than"));
}

TEST_F(Keyring, LeavesNothingOfAKeyThatCannotBeWritten) {
  const KeyFiles files(ring_, "foo");
  for (const fs::path& in_the_way : {files.key, files.permissions, files.certificate}) {
    fs::create_symlink(folder_ / "target", in_the_way);

    EXPECT_THAT(refusal([&] { add_key(ring_, "foo", Role::kView, ring_, {}); }),
                HasSubstr(in_the_way.string() + " cannot be written"));

    fs::remove(in_the_way);
    EXPECT_FALSE(fs::exists(folder_ / "target"));
    for (const fs::path& file : {files.key, files.permissions, files.certificate})
      EXPECT_FALSE(fs::exists(fs::symlink_status(file))) << file;
  }
  add_key(ring_, "foo", Role::kView, ring_, {});
  EXPECT_EQ(why_no_identity(ring_, Role::kView), "");
}

TEST_F(Keyring, LimitsAKeyToItsSessionsWhereThatIsAsked) {
  const std::string all = permissions_text(Role::kSim, "CN=x", {}, {});
  const std::string some = permissions_text(Role::kSim, "CN=x", {"bow", "string"}, {});

  EXPECT_THAT(all, HasSubstr("<partition>*</partition>"));
  EXPECT_THAT(some, HasSubstr("<partition>bow</partition><partition>string</partition>"));
  EXPECT_THAT(some, Not(HasSubstr("*")));
}

TEST_F(Keyring, ThatDoesNotExistIsAnErrorOfTheLaunchFile) {
  config::Launch launch;
  launch.file = "launch.yaml";
  EXPECT_EQ(keyring_of(launch), "");
  launch.security = ring_.string();
  EXPECT_EQ(keyring_of(launch), ring_.string());
  launch.security = (folder_ / "none").string();
  try {
    static_cast<void>(keyring_of(launch));
    FAIL() << "it names keys";
  } catch (const config::ConfigError& error) {
    EXPECT_THAT(error.problems().front().text(), HasSubstr("there is no folder '"));
    EXPECT_THAT(error.problems().front().text(),
                HasSubstr("`cordis keys new " + launch.security + "` makes one"));
  }
}

TEST(Certificate, SaysOfAFolderWithoutKeysThatItHasNone) {
  char name[] = "/tmp/cordis-test-XXXXXX";
  const fs::path folder = mkdtemp(name);

  EXPECT_THAT(refusal([&] { static_cast<void>(keys_in(folder)); }), HasSubstr("has no keys"));
  EXPECT_THAT(refusal([&] { static_cast<void>(identity_in(folder / "none", {Role::kSim}, "")); }),
              HasSubstr("No such file"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace cordis::node
