// cli/doctor/doctor_verb.cpp
#include "cli/doctor/doctor_verb.h"

#include <cstdio>
#include <memory>
#include <string>

#include <unistd.h>

#include "cli/doctor/diagnosis.h"
#include "cli/doctor/report.h"
#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/number.h"
#include "cli/run/console.h"

namespace cordis::cli {
namespace {

struct DoctorWords {
  std::string interface;
  std::string duration;
  std::string domain;
  std::string port;
  bool json = false;
  bool no_color = false;
};

DiagnosisOptions options_of(const DoctorWords& words) {
  constexpr int kMaxDomain = 101;
  constexpr int kMaxPort = 65535;
  DiagnosisOptions options;
  if (!words.duration.empty()) options.duration = parse_duration(words.duration);
  if (!words.domain.empty())
    options.domain = parse_whole_number("--domain", words.domain, 0, kMaxDomain);
  options.interface = words.interface;
  if (!words.port.empty())
    options.page_port = parse_whole_number("--port", words.port, 1, kMaxPort);
  return options;
}

int run(const DoctorWords& words) {
  const DiagnosisOptions options = options_of(words);
  if (!words.json && isatty(STDERR_FILENO) != 0)
    std::fprintf(stderr, "measuring for %s s...\r", in_seconds(options.duration).c_str());
  const std::vector<Finding> findings = diagnose(machine::SystemFiles(), options);
  const bool coloured = wants_colours(Stream::kOut, words.no_color);
  const std::string report = words.json ? report_json(findings) : report_text(findings, coloured);
  std::fputs(report.c_str(), stdout);
  return force_loop_works(findings) ? kSuccess : kFailure;
}

}  // namespace

void add_doctor_verb(CommandLine& line) {
  auto words = std::make_shared<DoctorWords>();
  Verb& verb = line.verb("doctor", "[options]",
                         "Check whether a force loop works on this machine, and what hinders it");
  verb.option("--duration", "TIME", words->duration, "How long to measure wake-ups [3s]");
  verb.option("--domain", "NUMBER", words->domain,
              "The DDS domain whose ports to check [that of the next session]");
  verb.option("--interface", "NAME", words->interface,
              "Check an interface for a session on several hosts: eth0 or its address");
  verb.option("--port", "NUMBER", words->port, "The port of the page to check [8080]");
  verb.flag("--json", words->json, "Print one JSON object");
  verb.flag("--no-color", words->no_color, "No colours, even on a terminal");
  verb.examples(
      "Every line says OK, warning or FAILURE, and what to do. docs/performance.md explains the\n"
      "figures. It needs no root, and changes nothing.\n"
      "Keys of the JSON: force_loop_at_1_khz, warnings, failures, and checks: of each its key,\n"
      "level (ok, warning, failure), text, advice, commands, values. Keys of the checks:\n"
      "versions, kernel.preemption, realtime.priority, realtime.memory, cpu.governor, cpu.steal,\n"
      "timer.resolution, timer.slack, timer.wakeups, network.loopback, network.buffers,\n"
      "network.dds_ports, network.interface, page.port, device.ports.\n"
      "Exit code: 0 a force loop at 1 kHz works, 1 it cannot work, 2 bad command line.\n\n"
      "Examples:\n"
      "  cordis doctor\n"
      "  cordis doctor --duration 60s\n"
      "  cordis doctor --json --domain 3 --port 8081\n");
  verb.action([words] { return run(*words); });
}

}  // namespace cordis::cli
