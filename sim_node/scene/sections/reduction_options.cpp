// sim_node/scene/sections/reduction_options.cpp
#include "sim_node/scene/sections/reduction_options.h"

#include <algorithm>
#include <array>

#include "node/config/mapping_reader.h"
#include "node/config/nearest_word.h"

namespace cordis::scene {

namespace {

using config::Value;

struct ReductionWord {
  const char* name;
  bool ReductionOptions::*wanted;
};
constexpr std::array<ReductionWord, 3> kReductionWords{{
    {"parallel", &ReductionOptions::parallel},
    {"series", &ReductionOptions::series},
    {"dimension", &ReductionOptions::dimension},
}};

/// The reductions of a list.
void read_names(const Value& list, ReductionOptions& options, config::Problems& problems) {
  std::vector<std::string> words;
  for (const ReductionWord& known : kReductionWords) words.emplace_back(known.name);
  for (const Value& item : list.items()) {
    const auto* const known =
        std::find_if(kReductionWords.begin(), kReductionWords.end(),
                     [&](const ReductionWord& word) { return item.text() == word.name; });
    if (known != kReductionWords.end()) {
      options.*known->wanted = true;
      continue;
    }
    problems.error(item.place(),
                   "a reduction is parallel, series or dimension, got " + item.described(),
                   config::did_you_mean(item.text(), words));
  }
}

}  // namespace

ReductionOptions read_reduce(const Value& value, bool by_itself, config::Problems& problems) {
  ReductionOptions options;
  if (value.kind() == Value::Kind::kSequence) {
    read_names(value, options, problems);
    return options;
  }
  const bool is_mapping = value.kind() == Value::Kind::kMapping;
  const bool is_word = value.text() == "all" || value.text() == "none";
  if (value.exists() && !is_mapping && !is_word) {
    problems.error(value.place(),
                   "'reduce' must be all, none, a list of reductions, or a mapping of them to true "
                   "and false, got " +
                       value.described());
  }
  config::MappingReader reader(is_mapping ? value : Value{}, "reduce", problems);
  for (const ReductionWord& word : kReductionWords) {
    options.*word.wanted =
        reader.optional_truth(word.name, is_word ? value.text() == "all" : by_itself);
  }
  reader.finish();
  return options;
}

}  // namespace cordis::scene
