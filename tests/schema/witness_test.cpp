// tests/schema/witness_test.cpp -- a file that ships uses every word of the languages.
#include <algorithm>
#include <array>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/schema/word_uses.h"

namespace cordis::test {
namespace {

/// Words that no file uses, by their beginning.
struct Exception {
  const char* beginning;
  const char* reason;
};

// Hardware, networks and runs differ from user to user; a file that ships cannot know them.
constexpr std::array kExceptions{
    Exception{"launch domain", "chosen at the start, or agreed on by several hosts"},
    Exception{"launch network", "the addresses of a network are those of whoever has one"},
    Exception{"launch security", "keys are secrets: none ships"},
    Exception{"launch record", "what is recorded is chosen at the start: cordis run --record"},
    Exception{"launch nodes.NAME.node: record_node", "as `record`"},
    Exception{"launch nodes.NAME.out", "of a record_node"},
    Exception{"launch nodes.NAME.topics", "of a record_node"},
    Exception{"launch nodes.NAME.exclude", "of a record_node"},
    Exception{"launch nodes.NAME.idl", "of a record_node"},
    Exception{"launch nodes.NAME.compression", "of a record_node"},
    Exception{"launch clock: asap", "chosen at the start, for scenes that no page shows"},
    Exception{"launch nodes.NAME.clock: ", "nodes that exist with another clock alone"},
    Exception{"launch nodes.NAME.respawn", "the default is what a gallery wants"},
    Exception{"launch nodes.NAME.duration_s", "set by cordis run --duration"},
    Exception{"launch nodes.NAME.signals_for", "set by cordis run --signals"},
    Exception{"launch nodes.NAME.recorded_by", "set by cordis run"},
    Exception{"launch nodes.NAME.force", "lets a scene run that surely diverges: none ships"},
    Exception{"launch nodes.NAME.paused", "set by cordis run for a paused scene that starts again"},
    Exception{"launch nodes.NAME.delay_quantile", "of a host that is late more often"},
    Exception{"launch nodes.NAME.threads", "of scenes larger than any that ships"},
    Exception{"launch nodes.NAME.address", "opens a page to the network: nothing that ships does"},
    Exception{"launch nodes.NAME.scenes", "what a page may load is a right that its owner gives"},
    Exception{"launch nodes.NAME.foxglove", "who may read all topics is a right likewise"},
    Exception{"device driver: ", "a driver of hardware is named by who has it"},
    Exception{"device stiffness_limit_n_per_m", "overrules the check of a device"},
    Exception{"device damping_limit_n_s_per_m", "overrules the check of a device"},
    Exception{"device power_limit_w", "of a motor that may not give all its force at full speed"},
    Exception{"device passivity", "the default guards every device that ships"},
    Exception{"device trace", "a file for whoever looks for a fault"},
    Exception{"device replay", "needs a take, and none ships"},
    Exception{"device firefader", "of hardware: no such device stands in the gallery"},
    Exception{"device kfb1.", "of hardware: serial lines and their times"},
    Exception{"device haply.", "of hardware: as its maker built it"},
    Exception{"device pointer.", "times of a page, for slow networks"},
    Exception{"device mock.sensor.", "sensors that are worse than those of the gallery"},
    Exception{"device mock.hand.gesture.", "places and kinds that `moves` say in the gallery"},
    Exception{"scene step.integrator: leapfrog", "`accuracy` takes it, and cordis lab compares it"},
    Exception{"scene step.integrator: symplectic4",
              "`accuracy` takes it, and cordis lab compares it"},
    Exception{"scene step.integrator: implicit", "`accuracy` takes it, and cordis lab compares it"},
    Exception{"scene start_state", "needs a state that a run has saved, and none ships"},
    Exception{"scene settle.steps", "for a scene that settles slowly"},
    Exception{"scene reduce.", "`reduce: all` takes all of them in the gallery"},
    Exception{"scene liaisons.NAME.kind: parallel", "may be left out, and is"},
    Exception{"scene liaisons.NAME.force_limit_n", "a state has one in the gallery"},
    Exception{"scene liaisons.NAME.rest", "a link says it in the gallery"},
    Exception{"scene liaisons.NAME.states.NAME.dissipation", "a liaison has one in the gallery"},
    Exception{"scene liaisons.NAME.states.NAME.friction: none",
              "a state of the gallery that slides has a lower friction"},
    Exception{"scene liaisons.NAME.states.NAME.friction.", "the liaison has them in the gallery"},
    Exception{"scene links.ITEM.stiffness_n_m_per_rad", "the liaison has it in the gallery"},
    Exception{"scene links.ITEM.viscosity_n_m_s_per_rad", "the liaison has it in the gallery"},
    Exception{"scene ports.NAME.ball.mass_kg", "of a port of role liaison; mass_kg says it too"},
    Exception{"scene matter.NAME.core.", "the core of a skin takes what the skin takes"},
    Exception{"scene matter.NAME.rest", "the links of matter take what other links take"},
    Exception{"scene matter.NAME.plane: ", "the other planes of a grid"},
    Exception{"expression sqrt", "a function of the language that no scene needs"},
    Exception{"expression log", "a function of the language that no scene needs"},
    Exception{"expression speed_y_m_per_s", "as speed_x_m_per_s"},
    Exception{"expression speed_z_m_per_s", "as speed_x_m_per_s"},
    Exception{"expression mass_a_kg", "as mass_b_kg"},
};

bool is_excepted(const std::string& word) {
  return std::ranges::any_of(kExceptions, [&](const Exception& exception) {
    return word.starts_with(exception.beginning);
  });
}

std::set<std::string> words_without_a_witness() {
  std::set<std::string> unused;
  std::ranges::set_difference(known_words(), used_words(), std::inserter(unused, unused.end()));
  return unused;
}

TEST(Witness, IsAFileThatShipsForEveryWord) {
  EXPECT_GT(known_words().size(), 300u);
  for (const std::string& word : words_without_a_witness())
    EXPECT_TRUE(is_excepted(word)) << "no file below launch_configs uses '" << word << "'";
}

TEST(Witness, IsMissingForEveryException) {
  const std::set<std::string> unused = words_without_a_witness();
  for (const Exception& exception : kExceptions) {
    EXPECT_TRUE(std::ranges::any_of(
        unused, [&](const std::string& word) { return word.starts_with(exception.beginning); }))
        << exception.beginning << ": a file uses it, or no reader takes it";
  }
}

}  // namespace
}  // namespace cordis::test
