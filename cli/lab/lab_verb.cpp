// cli/lab/lab_verb.cpp
#include "cli/lab/lab_verb.h"

#include <cstdio>
#include <memory>

#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/lab/lab.h"
#include "cli/lab/lab_chart.h"
#include "cli/lab/lab_report.h"
#include "cli/number.h"
#include "cli/progress_line.h"

namespace cordis::cli {
namespace {

struct LabWords {
  LabOptions options;
  std::string duration;
  std::string jobs = "1";
};

int run(LabOptions options) {
  LabReport report;
  {
    ProgressLine line;
    report = run_lab(options, [&line](const std::string& text) { line.show(text); });
    line.clear();
  }
  std::fputs(text_of(report).c_str(), stdout);
  std::puts(draw_chart(report, options.folder).c_str());
  return kSuccess;
}

}  // namespace

void add_lab_verb(CommandLine& line) {
  auto words = std::make_shared<LabWords>();
  LabOptions& options = words->options;
  Verb& verb =
      line.verb("lab", "SCENE [options]",
                "Run a scene with every integrator at many rates, and chart error against cost");
  verb.required_word("SCENE", options.file, "A scene, or a launch file whose devices play");
  verb.option("--out", "DIR", options.folder, "Where the results go [lab]");
  verb.option("--duration", "TIME", words->duration,
              "Length of a run, in simulated time [over_s of the scene, or 2s]");
  verb.option("--jobs", "COUNT", words->jobs, "Runs at the same time [1]");
  verb.flag("--quick", options.quick, "Few rates, within half a minute");
  verb.flag("--again", options.again, "Forget what an earlier lab has left in the folder");
  verb.examples(
      "The error of a run is the root mean square of its position errors against the reference\n"
      "integrator, over that of the motion itself (docs/lab.md). An interrupted lab continues\n"
      "where it was when it is started again.\n\n"
      "Examples:\n"
      "  cordis lab launch_configs/scenes/membrane.yaml --quick\n"
      "  cordis lab launch_configs/bowed_string.yaml --duration 3s --jobs 2 --out /tmp/bow\n");
  verb.action([words] {
    LabOptions& asked = words->options;
    if (asked.folder.empty()) asked.folder = "lab";
    if (!words->duration.empty()) {
      asked.duration_s = seconds_of(parse_duration(words->duration));
    }
    asked.jobs = parse_whole_number("--jobs", words->jobs, 1, 64);
    return run(asked);
  });
}

}  // namespace cordis::cli
