// sim_node/scene/names.cpp
#include "sim_node/scene/names.h"

#include <algorithm>
#include <utility>

namespace cordis::scene {

void Names::add(NameEntry entry, config::Problems& problems) {
  const std::string local = entry.name;
  entry.name = full(local);
  const auto [known, is_new] = entries_.try_emplace(entry.name, entry);
  if (is_new) return;
  if (known->second.is_of_liaison) {
    known->second = std::move(entry);
    return;
  }
  problems.error(entry.place, "the name '" + local + "' is used twice",
                 "first used at line " + std::to_string(known->second.place.line));
}

void Names::add_of_liaison(NameEntry entry) {
  entry.name = full(entry.name);
  entry.is_of_liaison = true;
  const auto [known, is_new] = entries_.try_emplace(entry.name, entry);
  NameEntry& all = known->second;
  if (is_new || !all.is_of_liaison) return;
  all.sound = all.sound && entry.sound;
  const bool is_beside = all.further.empty() && all.first + all.count == entry.first;
  all.count += entry.count;
  if (is_beside) return;
  all.further.push_back({entry.first, entry.count});
}

std::vector<IndexRun> NameEntry::runs() const {
  std::vector<IndexRun> runs{{first, count}};
  for (const IndexRun& run : further) runs.front().count -= run.count;
  runs.insert(runs.end(), further.begin(), further.end());
  return runs;
}

const NameEntry* Names::find(const std::string& name) const noexcept {
  const auto found = entries_.find(full(name));
  return found == entries_.end() ? nullptr : &found->second;
}

std::vector<const NameEntry*> Names::children(const std::string& name) const {
  const std::string prefix = name.empty() ? scope_ : full(name) + ".";
  std::vector<const NameEntry*> children;
  for (auto it = entries_.lower_bound(prefix);
       it != entries_.end() && it->first.starts_with(prefix); ++it) {
    const bool is_child = it->first.find_first_of(".[", prefix.size()) == std::string::npos;
    if (is_child && it->second.kind != Named::kLinks) children.push_back(&it->second);
  }
  std::stable_sort(children.begin(), children.end(),
                   [](const NameEntry* a, const NameEntry* b) { return a->first < b->first; });
  return children;
}

bool Names::is_before_links(const std::string& name) const noexcept {
  if (find(name) != nullptr) return false;
  const std::string beginning = full(name) + ".";
  const auto first = entries_.lower_bound(beginning);
  return first != entries_.end() && first->first.starts_with(beginning) &&
         first->second.kind == Named::kLinks;
}

bool Names::is_in_unsound(const std::string& name) const noexcept {
  for (std::size_t end = name.find_first_of(".["); end != std::string::npos;
       end = name.find_first_of(".[", end + 1)) {
    const NameEntry* around = find(name.substr(0, end));
    if (around != nullptr && !around->sound) return true;
  }
  return false;
}

std::vector<std::string> Names::words(bool with_links) const {
  std::vector<std::string> words;
  for (const auto& [name, entry] : entries_) {
    const bool is_nothing = entry.sound && entry.kind == Named::kLinks && entry.count == 0;
    if ((with_links || entry.kind != Named::kLinks) && !is_nothing && name.starts_with(scope_))
      words.push_back(name.substr(scope_.size()));
  }
  return words;
}

std::string Names::word_of(std::uint32_t index, bool is_link) const {
  const NameEntry* nearest = nullptr;
  std::uint32_t number = 0;  // in the nearest
  for (const auto& [name, entry] : entries_) {
    if ((entry.kind == Named::kLinks) != is_link) continue;
    std::uint32_t before = 0;
    for (const IndexRun& run : entry.runs()) {
      const bool is_here = index >= run.first && index - run.first < run.count;
      if (is_here && (nearest == nullptr || entry.count <= nearest->count)) {  // the innermost
        nearest = &entry;
        number = before + index - run.first;
      }
      before += run.count;
    }
  }
  if (nearest == nullptr) return std::to_string(index);
  std::string word = nearest->name;
  if (word.starts_with(scope_)) word.erase(0, scope_.size());
  return word.append("[").append(std::to_string(number)).append("]");
}

}  // namespace cordis::scene
