// sim_node/scene/sections/bends.cpp
#include "sim_node/scene/sections/bends.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>
#include <vector>

#include "node/assert.h"

namespace cordis::scene {

using config::Value;

namespace {

/// Three MATs, the middle one second.
using Triple = std::array<std::uint32_t, 3>;

std::optional<Selection> select_mats(Assembly& assembly, const Value& value, const char* what,
                                     config::MappingReader& reader, const char* key) {
  std::optional<Selection> picked = select(value, what, false, assembly.names, assembly.problems);
  if (picked && assembly.count_surfaces(picked->indices) > 0) {
    reader.error_at(key, "a surface does not bend");
    return std::nullopt;
  }
  return picked;
}

/// One to one, or one to many.
std::vector<Triple> triples_between(Assembly& assembly, config::MappingReader& reader) {
  const Value between = reader.required_sequence("between");
  if (between.exists() && between.items().size() != 3) {
    reader.error_at("between", "a bending liaison is between 3 ends, the middle one second, got " +
                                   std::to_string(between.items().size()));
    return {};
  }
  std::vector<Selection> ends;
  for (const Value& end : between.items()) {
    const auto picked = select_mats(assembly, end, "an end of a link", reader, "between");
    if (picked) ends.push_back(*picked);
  }
  if (ends.size() != 3) return {};
  std::uint32_t count = 1;
  for (const Selection& end : ends) count = std::max(count, end.count());
  const auto fits = [count](const Selection& end) {
    return end.count() == 1 || end.count() == count;
  };
  if (!std::ranges::all_of(ends, fits)) {
    reader.error_at("between", "the 3 ends must be equally many MATs, or one");
    return {};
  }
  std::vector<Triple> triples(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::size_t end = 0; end < 3; ++end) {
      triples[i][end] = ends[end].indices[ends[end].count() == 1 ? 0 : i];
    }
  }
  return triples;
}

/// The lines of all matter that may have MATs between these: copies of a part do not look at each other.
std::span<const MatterLine> lines_between(const Assembly& assembly, std::uint32_t first,
                                          std::uint32_t last) {
  const std::vector<MatterLine>& lines = assembly.lines;
  const auto end = std::ranges::upper_bound(lines, last, {}, &MatterLine::first_of_matter);
  auto begin =
      std::ranges::upper_bound(lines.begin(), end, first, {}, &MatterLine::first_of_matter);
  if (begin != lines.begin()) {
    const std::uint32_t of_first = std::prev(begin)->first_of_matter;
    begin =
        std::ranges::lower_bound(lines.begin(), end, of_first, {}, &MatterLine::first_of_matter);
  }
  return {begin, end};
}

/// Each three neighbours of a line that are all picked.
std::vector<Triple> triples_along(Assembly& assembly, config::MappingReader& reader) {
  const auto picked =
      select_mats(assembly, reader.required_value("along"), "'along' in a link", reader, "along");
  if (!picked) return {};
  const auto [first, last] = std::ranges::minmax(picked->indices);
  std::vector<bool> is_picked(last + 1 - first);
  for (const std::uint32_t mat : picked->indices) is_picked[mat - first] = true;
  const auto counts = [&, begin = first, end = last](std::uint32_t mat) {
    return mat >= begin && mat <= end && is_picked[mat - begin];
  };
  std::vector<Triple> triples;
  for (const auto& [of_matter, line] : lines_between(assembly, first, last)) {
    for (std::size_t i = 0; i + 2 < line.size(); ++i) {
      const Triple triple{line[i], line[i + 1], line[i + 2]};
      if (std::ranges::all_of(triple, counts)) triples.push_back(triple);
    }
  }
  if (triples.empty()) {
    reader.error_at("along", "no three neighbours of a line are picked",
                    "strings, rings, points and grids have lines; else write between: [a, b, c]");
  }
  return triples;
}

/// Adds a bend of a law. @return false after a problem
bool add_bend(Assembly& assembly, const LinkLaw& link, const Triple& mats,
              config::MappingReader& reader, const char* key) {
  const auto& [a, b, c] = mats;
  const BendLaw& law = *link.bend;
  const auto called = [&](std::uint32_t mat) { return assembly.names.word_of(mat, false); };
  if (a == b || b == c || a == c) {
    reader.error_at(key, "the ends of a bending liaison must differ, got '" +
                             called(a == b || a == c ? a : b) + "' twice");
    return false;
  }
  const auto& network = assembly.scene.network;
  const auto length = [&](std::uint32_t from, std::uint32_t to) {
    return law.length.value_or((network.mats[to].position - network.mats[from].position).norm());
  };
  const engine::Bend bend{
      a,
      b,
      c,
      law.stiffness,
      law.viscosity,
      law.rest_angle,
      length(a, b),
      length(b, c),
      link.state_machine == nullptr ? engine::Bend::kNone : link.state_machine_index};
  if (bend.length_ab <= 0.0 || bend.length_bc <= 0.0) {
    reader.error_at(key,
                    "'" + called(b) + "' and '" + called(bend.length_ab <= 0.0 ? a : c) +
                        "' start at the same point, so the length between them is not known",
                    "give the liaison a 'length_m'");
    return false;
  }
  assembly.scene.network.bends.push_back(bend);
  return true;
}

/// Adds a bend for each three. @return false after a problem
bool add_bends(Assembly& assembly, const LinkEntry& entry, const std::vector<Triple>& triples,
               const char* key) {
  const auto first = static_cast<std::uint32_t>(assembly.scene.network.bends.size());
  if (sum(assembly.link_counts()) + triples.size() > kMaxLinks) {
    assembly.refuse_more(entry.reader.place_of(key),
                         "the scene has more than " + std::to_string(kMaxLinks) + " links");
    return false;
  }
  for (const Triple& triple : triples) {
    if (!add_bend(assembly, *entry.law, triple, entry.reader, key)) return false;
  }
  assembly.scene.bends.push_back({assembly.names.full(entry.name), first,
                                  static_cast<std::uint32_t>(triples.size()),
                                  entry.reader.place()});
  return true;
}

}  // namespace

void read_bends(Assembly& assembly, LinkEntry& entry) {
  CORDIS_ASSERT(entry.law && entry.law->bend);
  config::MappingReader& reader = entry.reader;
  for (const char* other : {"within", "between_sets"}) {
    if (reader.optional_value(other).exists()) {
      reader.error_at(other, "a bending liaison acts between three MATs, not in sets",
                      "write along: matter, or between: [a, b, c]");
      return;
    }
  }
  const bool is_along = reader.has("along");
  const char* key = is_along ? "along" : "between";
  if (is_along && reader.has("between"))
    reader.error_at("along", "either 'along' or 'between' can be given in link");
  if (is_along) reader.optional_value("between");
  const std::vector<Triple> triples =
      is_along ? triples_along(assembly, reader) : triples_between(assembly, reader);
  const LinkCounts before = assembly.link_counts();
  const bool sound = assembly.problems.error_count() == entry.errors_before &&
                     add_bends(assembly, entry, triples, key);
  if (entry.has_name) {
    assembly.name_links(entry.name, before, sound, reader.place_of("name"), &*entry.law);
  } else {
    if (sound) assembly.add_group(entry.name, LinkKind::kBend, before, reader.place(), &*entry.law);
    assembly.call_after_liaison(entry.name, LinkKind::kBend, before, sound, reader.place());
  }
}

}  // namespace cordis::scene
