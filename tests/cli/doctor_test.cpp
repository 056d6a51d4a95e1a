// tests/cli/doctor_test.cpp -- what `cordis doctor` makes of a machine.
#include <sstream>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "cli/doctor/cpu_check.h"
#include "cli/doctor/device_check.h"
#include "cli/doctor/diagnosis.h"
#include "cli/doctor/kernel_check.h"
#include "cli/doctor/network_check.h"
#include "cli/doctor/realtime_check.h"
#include "cli/doctor/report.h"
#include "cli/doctor/timer_check.h"
#include "cli/doctor/version_check.h"
#include "tests/support/fake_root.h"

namespace cordis::cli {
namespace {

using machine::CoreWakeups;
using machine::FakeRoot;

constexpr std::int64_t kMillisecond = 1'000'000;

std::string model_of(const FakeRoot& machine, const std::string& version) {
  return check_preemption(machine.files(), "6.1.0", version).values["model"];
}

TEST(Doctor, ReadsThePreemptionModelWhereverTheKernelReportsIt) {
  const FakeRoot machine;
  EXPECT_EQ(model_of(machine, "#1 SMP Debian 6.1"), "unknown");
  EXPECT_EQ(model_of(machine, "#1 SMP PREEMPT_DYNAMIC Debian"), "unknown");
  EXPECT_EQ(model_of(machine, "#1 SMP PREEMPT Debian"), "full");
  EXPECT_EQ(model_of(machine, "#1 SMP PREEMPT_RT Debian"), "realtime");
  machine.put("proc/config.gz", "CONFIG_PREEMPT_LAZY=y\n");  // not compressed is read as well
  EXPECT_EQ(model_of(machine, "#1 SMP PREEMPT_DYNAMIC Debian"), "lazy");
  machine.put("boot/config-6.1.0", "CONFIG_X=y\nCONFIG_PREEMPT_VOLUNTARY=y\n");
  EXPECT_EQ(model_of(machine, "#1 SMP PREEMPT_DYNAMIC Debian"), "voluntary");
  machine.put("proc/cmdline", "quiet preempt=full ro\n");
  EXPECT_EQ(model_of(machine, "#1 SMP PREEMPT_DYNAMIC Debian"), "full");
  machine.put("sys/kernel/debug/sched/preempt", "(none) voluntary full\n");
  EXPECT_EQ(model_of(machine, "#1 SMP PREEMPT_DYNAMIC Debian"), "none");
  machine.put("sys/kernel/realtime", "1\n");
  EXPECT_EQ(model_of(machine, "#1 SMP Debian"), "realtime");
}

TEST(Doctor, WarnsOfAKernelThatIsNotPreempted) {
  const FakeRoot machine;
  machine.put("boot/config-6.1.0", "CONFIG_PREEMPT_NONE=y\n");
  const Finding fixed = check_preemption(machine.files(), "6.1.0", "#1 SMP");
  EXPECT_EQ(fixed.level, Level::kWarning);
  EXPECT_EQ(fixed.commands.at(0), "sudo apt install linux-image-rt-amd64");
  const Finding dynamic = check_preemption(machine.files(), "6.1.0", "#1 SMP PREEMPT_DYNAMIC");
  EXPECT_NE(dynamic.advice.find("preempt=full"), std::string::npos);
}

TEST(Doctor, SaysHowToPermitRealtimePriorityAndLockedMemory) {
  EXPECT_EQ(check_priority({true, true, "0", "0"}).level, Level::kOk);
  EXPECT_EQ(check_memory_lock({true, true, "0", "0"}).level, Level::kOk);
  const Finding priority = check_priority({false, false, "0", "8388608"});
  EXPECT_EQ(priority.level, Level::kWarning);
  EXPECT_NE(priority.commands.at(0).find("rtprio 90"), std::string::npos);
  const Finding memory = check_memory_lock({false, false, "0", "8388608"});
  EXPECT_EQ(memory.level, Level::kWarning);
  EXPECT_NE(memory.commands.at(0).find("memlock unlimited"), std::string::npos);
}

TEST(Doctor, CountsTheGovernorsOfTheCores) {
  const FakeRoot machine;
  EXPECT_EQ(check_governor(machine.files()).level, Level::kOk);
  machine.put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance\n");
  machine.put("sys/devices/system/cpu/cpufreq/nothing", "");
  EXPECT_EQ(check_governor(machine.files()).level, Level::kOk);
  machine.put("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave\n");
  const Finding mixed = check_governor(machine.files());
  EXPECT_EQ(mixed.level, Level::kWarning);
  EXPECT_EQ(mixed.values["cores"]["powersave"], 1);
}

TEST(Doctor, WarnsOfAHypervisorThatTakesProcessorTime) {
  EXPECT_EQ(check_steal(std::nullopt).level, Level::kOk);
  EXPECT_EQ(check_steal(0.0).level, Level::kOk);
  EXPECT_EQ(check_steal(0.005).level, Level::kOk);
  EXPECT_EQ(check_steal(0.12).level, Level::kWarning);
  EXPECT_NE(check_steal(0.12).text.find("12 %"), std::string::npos);
}

TEST(Doctor, FailsWithoutATimerThatIsFineEnough) {
  EXPECT_EQ(check_resolution(1).level, Level::kOk);
  EXPECT_EQ(check_resolution(4'000'000).level, Level::kUnusable);
  EXPECT_EQ(check_slack(50'000, 1).level, Level::kOk);
  EXPECT_EQ(check_slack(50'000, 50'000).level, Level::kWarning);
}

/// A core on which every hundredth wake-up is late by so much.
CoreWakeups core_with(int core, std::int64_t late_nsec, bool realtime = false) {
  CoreWakeups wakeups{core, {}, {}};
  for (int n = 0; n < 3000; ++n)
    wakeups.normal.record(n % 100 == 0 ? late_nsec : 20'000, kMillisecond);
  if (!realtime) return wakeups;
  wakeups.realtime.emplace();
  for (int n = 0; n < 3000; ++n) wakeups.realtime->record(20'000, kMillisecond);
  return wakeups;
}

TEST(Doctor, JudgesWakeUpsAsTheLoopsGetThem) {
  EXPECT_EQ(check_wakeups({core_with(0, 100'000)}, 3.0).level, Level::kOk);
  // Late by 2 ms once in 100: 1 % and more.
  EXPECT_EQ(check_wakeups({core_with(0, 2 * kMillisecond)}, 3.0).level, Level::kWarning);
  // By 30 ms: a fourth of all ticks is lost.
  EXPECT_EQ(check_wakeups({core_with(0, 30 * kMillisecond)}, 3.0).level, Level::kUnusable);
  EXPECT_EQ(check_wakeups({core_with(0, 30 * kMillisecond, true)}, 3.0).level, Level::kOk);
  // A core that did not wake once.
  EXPECT_EQ(check_wakeups({CoreWakeups{}}, 3.0).level, Level::kUnusable);
}

TEST(Doctor, ShowsTheWorstOfManyCoresAndKeepsAllForPrograms) {
  std::vector<CoreWakeups> cores;
  for (int core = 0; core < 12; ++core) cores.push_back(core_with(core, core * 10'000));
  const Finding finding = check_wakeups(cores, 3.0);
  EXPECT_EQ(finding.values["cores"].size(), 12u);
  ASSERT_EQ(finding.table.size(), 10u);  // header, eight cores, the rest in a line
  EXPECT_TRUE(finding.table[1].starts_with("  11")) << finding.table[1];
  EXPECT_EQ(finding.table.back(), "and 4 cores less late");
}

/// A socket bound to a port of 127.0.0.1, or to any free one.
class TakenPort {
 public:
  explicit TakenPort(int type, int port = 0) : file_(socket(AF_INET, type, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    socklen_t size = sizeof address;
    bind(file_, reinterpret_cast<sockaddr*>(&address), size);
    if (type == SOCK_STREAM) listen(file_, 1);
    getsockname(file_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~TakenPort() { close(file_); }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;
  int port() const noexcept { return port_; }

 private:
  int file_;
  int port_ = 0;
};

TEST(Doctor, NamesAFreePortWhenThatOfThePageIsTaken) {
  const TakenPort taken(SOCK_STREAM);
  const Finding finding = check_page_port(taken.port());
  EXPECT_EQ(finding.level, Level::kWarning);
  EXPECT_NE(finding.values["free_port"], taken.port());
  EXPECT_NE(finding.advice.find("view.port="), std::string::npos);
}

TEST(Doctor, ChecksAnInterfaceForASessionOnSeveralHosts) {
  constexpr int kDomain = 100;
  const Finding any = check_interface("", kDomain);
  EXPECT_EQ(any.level, Level::kOk) << "no session needs one";
  const Finding absent = check_interface("eth77x", kDomain);
  EXPECT_EQ(absent.level, Level::kWarning);
  EXPECT_NE(absent.text.find("'eth77x' is no interface"), std::string::npos);
  EXPECT_NE(absent.advice, "");
  for (const auto& one : any.values["interfaces"]) {
    const auto name = one["name"].get<std::string>();
    EXPECT_NE(any.text.find(name), std::string::npos);
    const Finding found = check_interface(name, kDomain);
    EXPECT_EQ(found.values["taken"], 0) << found.text;
    EXPECT_GT(found.values["largest_packet_bytes"].get<int>(), 0);
    EXPECT_EQ(check_interface(found.values["address"], kDomain).values["name"], name);
  }
}

TEST(Doctor, CountsTheDdsPortsThatAreTaken) {
  constexpr int kDomain = 100;  // no test has it: those begin at 10 and end far below
  constexpr int kPort = 7400 + 250 * kDomain + 10;
  const Finding before = check_dds_ports(kDomain);
  const TakenPort taken(SOCK_DGRAM, kPort);
  const Finding after = check_dds_ports(kDomain);
  EXPECT_EQ(after.level, Level::kWarning);
  EXPECT_GE(after.values["taken"].get<int>(), 1);
  EXPECT_LE(before.values["taken"].get<int>(), after.values["taken"].get<int>());
  EXPECT_NE(after.values["free_domain"], kDomain);
}

TEST(Doctor, SaysWhoMayUseASerialLine) {
  const FakeRoot machine;
  const auto refused_all = [](const std::string&) { return false; };
  EXPECT_EQ(check_devices(machine.files(), refused_all).text, "no device connected");
  machine.put("dev/ttyACM0", "");
  machine.put("dev/ttyUSB3", "");
  machine.put("dev/ttyS0", "");
  const Finding permitted = check_devices(machine.files(), [](const auto&) { return true; });
  EXPECT_EQ(permitted.level, Level::kOk);
  EXPECT_EQ(permitted.text, "/dev/ttyACM0, /dev/ttyUSB3: permitted");
  const Finding refused = check_devices(machine.files(), refused_all);
  EXPECT_EQ(refused.level, Level::kWarning);
  EXPECT_TRUE(refused.commands.at(0).starts_with("sudo usermod -aG "));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Doctor, WorksWhereTheKernelReportsNothing) {
  const FakeRoot machine;
  DiagnosisOptions options;
  options.duration = std::chrono::milliseconds(100);
  const std::vector<Finding> findings = diagnose(machine.files(), options);
  const std::vector<std::string> keys{"versions",          "kernel.preemption", "realtime.priority",
                                      "realtime.memory",   "cpu.governor",      "cpu.steal",
                                      "timer.resolution",  "timer.slack",       "timer.wakeups",
                                      "network.loopback",  "network.buffers",   "network.dds_ports",
                                      "network.interface", "page.port",         "device.ports"};
  ASSERT_EQ(findings.size(), keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) EXPECT_EQ(findings[i].key, keys[i]);
}

TEST(DoctorReport, FitsAHundredColumns) {
  const FakeRoot machine;
  std::vector<Finding> findings{check_priority({false, false, "0", "8388608"}),
                                check_memory_lock({false, false, "0", "8388608"}),
                                check_wakeups({core_with(0, 30 * kMillisecond, false)}, 3.0),
                                check_steal(0.3),
                                check_socket_buffers(),
                                check_loopback()};
  for (const std::string& line : lines_of(report_text(findings, /*coloured=*/false)))
    EXPECT_LE(line.size(), 100u) << line;
}

TEST(DoctorReport, SaysWhetherAForceLoopWorks) {
  Finding finding{.key = "a.b", .title = "something", .text = "is well"};
  EXPECT_TRUE(force_loop_works({finding}));
  EXPECT_EQ(report_text({finding}, false),
            R"(OK       something            is well
A force loop at 1 kHz works on this machine.
)");
  finding.level = Level::kWarning;
  finding.advice = "mend it";
  EXPECT_TRUE(force_loop_works({finding}));
  EXPECT_EQ(report_text({finding}, false),
            R"(warning  something            is well
                              What to do: mend it.
A force loop at 1 kHz works on this machine, with 1 warning.
)");
  finding.level = Level::kUnusable;
  finding.commands = {"mend it"};
  EXPECT_FALSE(force_loop_works({finding}));
  EXPECT_EQ(report_text({finding}, false),
            R"(FAILURE  something            is well
                              What to do: mend it:
           mend it
A force loop at 1 kHz cannot work on this machine.
)");
}

TEST(DoctorReport, IsJsonForPrograms) {
  Finding finding{.key = "a.b", .title = "something", .level = Level::kUnusable, .text = "is ill"};
  finding.values = {{"share", 0.5}};
  const auto report = nlohmann::json::parse(report_json({finding}));
  EXPECT_EQ(report["force_loop_at_1_khz"], false);
  EXPECT_EQ(report["failures"], 1);
  EXPECT_EQ(report["checks"][0]["key"], "a.b");
  EXPECT_EQ(report["checks"][0]["level"], "failure");
  EXPECT_EQ(report["checks"][0]["values"]["share"], 0.5);
}

}  // namespace
}  // namespace cordis::cli
