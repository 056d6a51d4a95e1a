// cli/simplify/simplify_verb.cpp -- cordis simplify: writes the equivalent scene with less in it.
#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "cli/exit_code.h"
#include "cli/simplify/simplify.h"
#include "cli/verbs.h"

namespace cordis::cli {
namespace {

struct SimplifyWords {
  std::string scene_file;
  std::string out;
};

int simplify(const SimplifyWords& words) {
  config::Problems problems;
  scene::Scene scene = scene::load_scene(words.scene_file, problems);
  problems.throw_if_any();
  const Simplified simplified = simplify_scene(std::move(scene), problems);
  problems.throw_if_any();
  if (words.out.empty()) {
    std::fputs(simplified.text.c_str(), stdout);
  } else {
    std::ofstream file(words.out);
    file << simplified.text << std::flush;
    if (!file) throw std::runtime_error("cannot write " + words.out);
  }
  std::fputs(simplified.report.c_str(), stderr);
  return kSuccess;
}

}  // namespace

void add_simplify_verb(CommandLine& line) {
  auto words = std::make_shared<SimplifyWords>();
  Verb& verb = line.verb("simplify", "SCENE [options]",
                         "Write the equivalent scene with fewer links, masses and directions");
  verb.required_word("SCENE", words->scene_file, "The scene file");
  verb.option("--out", "FILE", words->out, "Where to write it [stdout]");
  verb.examples(
      "Makes the reductions of docs/reductions.md, those that `reduce` in the scene asks for, or "
      "all,\n"
      "and says on stderr what each took out and what it costs. The scene is written MAT by MAT "
      "and\n"
      "link by link: generators, parts and included files are gone, the names of matter stay.\n"
      "Exit code: 0 written, 2 bad file or command line.\n\n"
      "Examples:\n"
      "  cordis simplify launch_configs/scenes/plucked_string.yaml --out simple.yaml\n"
      "  cordis check simple.yaml\n");
  verb.action([words] { return simplify(*words); });
}

}  // namespace cordis::cli
