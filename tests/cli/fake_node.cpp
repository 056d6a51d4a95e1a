// tests/cli/fake_node.cpp -- stands in the place of a node, and does what the environment says.
//
// FAKE_NAME (with --check: FAKE_CHECK_NAME) holds commands with `;` between them, done one after
// the other. Where `|` stands between lists of them, the first start of the node does the first
// list, the second start the second, and every further start the last; NAME.starts beside the
// launch file counts them. The commands are:
//   say TEXT      a line on stdout            error TEXT   a line on stderr
//   begin TEXT    TEXT without a newline      words        its own command line as a line
//   pid           a line `pid N`              child        starts a process that only SIGKILL ends;
//   a line `pid N` deaf          ignores SIGINT and SIGTERM  flood        a line on stdout, again
//   and again, without end exit N        ends                        die N        is killed by
//   signal N run TEXT      publishes node/status: phase running, text TEXT, some figures
//   phase PHASE   the same in another phase
//   late N        the same, running, N ticks late by the machine; the other side is silent for one
//   tick, and for 500 once the node is asked to stop
// At the end it waits for SIGINT or SIGTERM, says `stopped`, and ends with exit code 0.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

#include "node/config/launch.h"
#include "node/status.h"
#include "node/status_words.h"
#include "node/time.h"

namespace {

using namespace cordis;

struct Self {
  std::string launch_file;
  std::string name;
  std::string kind;
  std::string words;
  std::vector<std::string> overrides;
  bool check = false;
};

Self read_words(int argc, char** argv) {
  Self self;
  const std::string program = argv[0];
  self.kind = program.substr(program.rfind('/') + 1);
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    self.words += (i > 1 ? " " : "") + word;
    if (i == 1) self.launch_file = word;
    if (word == "--name" && i + 1 < argc) self.name = argv[i + 1];
    if (word == "--check") self.check = true;
    if (word.find('=') != std::string::npos) self.overrides.push_back(word);
  }
  return self;
}

msg::NodeKind kind_of(const std::string& word) {
  for (const msg::NodeKind kind : {msg::KIND_SIM_NODE, msg::KIND_DEVICE_NODE}) {
    if (word == node::word_of(kind)) return kind;
  }
  return msg::KIND_VIZ_NODE;
}

msg::NodePhase phase_of(const std::string& word) {
  std::uint32_t phase = 0;
  while (phase < msg::PHASE_FAILED && word != node::word_of(static_cast<msg::NodePhase>(phase)))
    ++phase;
  return static_cast<msg::NodePhase>(phase);
}

std::atomic<bool> is_stopping{false};

/// Says what a node says of itself, as long as it lives.
class FakeStatus {
 public:
  FakeStatus(const Self& self, msg::NodePhase phase, const std::string& text,
             std::uint64_t late = 0)
      : participant_(config(self)) {
    const auto run = static_cast<std::uint64_t>(node::monotonic_nsec());
    publisher_ = std::make_unique<node::StatusPublisher>(
        participant_, kind_of(self.kind), run, [phase, text, late](msg::NodeStatus& status) {
          status.phase(phase);
          status.text(text);
          status.target_rate_hz(1000);
          status.ticks(status.ticks() + 1);
          if (late > 0) status.silent_ticks(is_stopping ? 500 : 1);
          status.late_by_machine(late);
          status.step(4711);
          status.state_hash(0x0123456789abcdefull);
        });
  }

 private:
  static dds::ParticipantConfig config(const Self& self) {
    config::Problems problems;
    const config::Launch launch = config::load_launch(self.launch_file, self.overrides, problems);
    return {launch.domain.value(), launch.session, self.name, false};
  }

  dds::Participant participant_;
  std::unique_ptr<node::StatusPublisher> publisher_;
};

void start_deaf_child() {
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGTERM, SIG_IGN);
    std::signal(SIGINT, SIG_IGN);
    for (;;) pause();
  }
  std::cout << "pid " << child << std::endl;
}

void wait_for(std::initializer_list<int> numbers) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : numbers) sigaddset(&signals, number);
  int arrived = 0;
  sigwait(&signals, &arrived);
}

bool asked_to_stop() {
  sigset_t waiting;
  sigpending(&waiting);
  return sigismember(&waiting, SIGTERM) == 1;
}

/// The list of commands for this start of the node.
std::string list_of_this_start(const std::string& all, const Self& self) {
  std::vector<std::string> lists;
  std::istringstream text(all);
  for (std::string list; std::getline(text, list, '|');) lists.push_back(list);
  if (lists.size() < 2) return all;
  const std::string counter =
      self.launch_file.substr(0, self.launch_file.rfind('/') + 1) + self.name + ".starts";
  std::size_t starts = 0;
  std::ifstream(counter) >> starts;
  std::ofstream(counter) << starts + 1;
  return lists[std::min(starts, lists.size() - 1)];
}

void execute(const std::string& command, const Self& self, std::unique_ptr<FakeStatus>& status) {
  std::istringstream words(command);
  std::string verb;
  std::string rest;
  words >> verb;
  std::getline(words >> std::ws, rest);
  if (verb == "say") std::cout << rest << std::endl;
  if (verb == "error") std::cerr << rest << std::endl;
  if (verb == "begin") std::cout << rest << std::flush;
  if (verb == "words") std::cout << self.words << std::endl;
  if (verb == "pid") std::cout << "pid " << getpid() << std::endl;
  if (verb == "child") start_deaf_child();
  while (verb == "deaf") pause();
  while (verb == "flood" && !asked_to_stop()) std::cout << "drop of a flood\n";
  if (verb == "await") wait_for({SIGUSR1});
  if (verb == "exit") std::exit(std::stoi(rest));
  if (verb == "die") raise(std::stoi(rest));
  if (verb == "run") status = std::make_unique<FakeStatus>(self, msg::PHASE_RUNNING, rest);
  if (verb == "late")
    status = std::make_unique<FakeStatus>(self, msg::PHASE_RUNNING, "", std::stoul(rest));
  if (verb == "phase") status = std::make_unique<FakeStatus>(self, phase_of(rest), "");
}

}  // namespace

int main(int argc, char** argv) {
  const Self self = read_words(argc, argv);
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : {SIGINT, SIGTERM, SIGUSR1}) sigaddset(&signals, number);
  sigprocmask(SIG_BLOCK, &signals, nullptr);

  const std::string variable = (self.check ? "FAKE_CHECK_" : "FAKE_") + self.name;
  const char* commands = std::getenv(variable.c_str());
  std::unique_ptr<FakeStatus> status;
  std::istringstream script(commands != nullptr ? list_of_this_start(commands, self) : "");
  for (std::string command; std::getline(script, command, ';');) execute(command, self, status);
  if (self.check) return 0;

  wait_for({SIGINT, SIGTERM});
  is_stopping = true;
  std::cout << "stopped" << std::endl;
  return 0;
}
