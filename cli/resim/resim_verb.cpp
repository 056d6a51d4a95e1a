// cli/resim/resim_verb.cpp
#include "cli/resim/resim_verb.h"

#include <cstdio>
#include <memory>
#include <stdexcept>

#include "cli/exit_code.h"
#include "cli/number.h"
#include "cli/resim/rehash.h"
#include "cli/resim/resim.h"
#include "node/terminal_text.h"
#include "record_node/mcap/file_error.h"

namespace cordis::cli {
namespace {

struct ResimWords {
  ResimOptions options;
  std::string tolerance;
  bool expects = false;
  bool rehashes = false;
};

int exit_code_of(const ResimResult& result, bool expects) {
  if (expects) {
    const bool holds = result.by == FrameCheck::By::kHash && result.is_equal() &&
                       result.loss.empty() && result.other_lives == 0;
    return holds ? kSuccess : kFailure;
  }
  if (!result.failure.empty() && !result.compares_models()) return kFailure;
  if (!result.compares_models() && result.findings.frames > 0 && !result.is_equal())
    return kFailure;
  if (!result.loss.empty() || result.findings.frames == 0 || result.other_lives > 0) return kLoss;
  return kSuccess;
}

int renew(const ResimWords& words, const ResimResult& result) {
  if (!result.loss.empty() || !result.failure.empty() || result.computed.empty()) {
    std::fprintf(stderr, "the take stays as it is: only one that is complete is renewed\n");
    return kLoss;
  }
  if (result.other_lives > 0 || result.findings.unmatched > 0) {
    std::fprintf(stderr, result.other_lives > 0
                             ? "the take stays as it is: sim_node restarted in it\n"
                             : "the take stays as it is: not every frame was computed again\n");
    return kLoss;
  }
  try {
    rehash(words.options.take, result);
  } catch (const std::runtime_error& error) {
    std::fprintf(stderr, "the take stays as it is: %s\n", error.what());
    return kFailure;
  }
  std::printf("%s is renewed: from now on it is compared with what this version computes\n",
              words.options.take.c_str());
  return kSuccess;
}

int run(ResimWords& words) {
  const bool changes_model = !words.options.scene_file.empty() ||
                             !words.options.integrator.empty() || !words.options.words.empty();
  if (changes_model && (words.expects || words.rehashes)) {
    throw UsageError("--expect and --rehash are for the model of the take; leave out the change");
  }
  if (words.expects && words.rehashes) throw UsageError("either --expect or --rehash");
  words.options.keeps_computed = words.rehashes;
  try {
    const ResimResult result = resimulate(words.options);
    node::print_text(stdout, text_of(result, words.options));
    if (words.rehashes) return renew(words, result);
    if (words.expects && result.by == FrameCheck::By::kPosition) {
      std::printf("where the change is wanted: cordis resim %s --rehash\n",
                  words.options.take.c_str());
    }
    return exit_code_of(result, words.expects);
  } catch (const mcap::FileError& error) {
    throw UsageError(error.what());
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

}  // namespace

void add_resim_verb(CommandLine& line) {
  auto words = std::make_shared<ResimWords>();
  Verb& verb = line.verb("resim", "TAKE [words] [options]",
                         "Compute a recorded session again, and compare it with what was recorded");
  verb.required_word("TAKE", words->options.take, "A recording with the topic scene/inputs");
  verb.more_words("words", words->options.words,
                  "Another model under the same hand: NAME.PARAMETER=VALUE, as `cordis ctl set`");
  verb.option("--scene", "FILE", words->options.scene_file, "Another scene under the same hand");
  verb.option("--integrator", "NAME", words->options.integrator,
              "Another integrator under the same hand");
  verb.option("--tolerance", "M", words->tolerance,
              "For positions, where hashes are of another version [1e-6]");
  verb.flag("--expect", words->expects,
            "For a test: any take that is not whole and equal, hash for hash, is a failure");
  verb.flag("--rehash", words->rehashes,
            "Renew the hashes of the take, after a change that is wanted");
  verb.examples(
      "Without DDS, as fast as it can. Every frame of the take is compared with the scene that "
      "its\n"
      "inputs lead to (docs/recording.md). With another model the report says how far positions\n"
      "and the forces on ports differ.\n"
      "Exit code: 0 equal or compared, 1 it differs, 2 a file or a word is wrong, 3 the take "
      "lacks\n"
      "something, or sim_node began again in it: a part is not compared.\n\n"
      "Examples:\n"
      "  cordis resim take.mcap\n"
      "  cordis resim take.mcap --integrator leapfrog\n"
      "  cordis resim take.mcap --scene launch_configs/scenes/plucked_string.yaml\n"
      "  cordis resim tests/golden/lockstep_thimbles.mcap --expect\n");
  verb.action([words] {
    if (!words->tolerance.empty())
      words->options.tolerance_m = parse_number("--tolerance", words->tolerance, 0.0, 1e3);
    return run(*words);
  });
}

}  // namespace cordis::cli
