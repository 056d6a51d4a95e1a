// sim_node/run/input_kind.cpp
#include "sim_node/run/input_kind.h"

#include <algorithm>
#include <array>
#include <utility>

#include "node/assert.h"

namespace cordis::sim {
namespace {

using Row = std::pair<msg::ControlVerb, msg::InputKind>;

constexpr std::array kRows{
    Row{msg::VERB_PAUSE, msg::INPUT_PAUSE}, Row{msg::VERB_RESUME, msg::INPUT_RESUME},
    Row{msg::VERB_STEP, msg::INPUT_STEP},   Row{msg::VERB_RESET, msg::INPUT_RESET},
    Row{msg::VERB_SET, msg::INPUT_SET},     Row{msg::VERB_STATE, msg::INPUT_STATE}};

}  // namespace

msg::InputKind input_kind_of(msg::ControlVerb verb) noexcept {
  const auto* const row = std::ranges::find(kRows, verb, &Row::first);
  CORDIS_ASSERT(row != kRows.end());
  return row->second;
}

std::optional<msg::ControlVerb> verb_of(msg::InputKind kind) noexcept {
  const auto* const row = std::ranges::find(kRows, kind, &Row::second);
  if (row == kRows.end()) return std::nullopt;
  return row->first;
}

}  // namespace cordis::sim
