// sim_node/scene/names.h -- the names of a scene: what a selection is looked up in.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "node/config/problem.h"
#include "sim_node/scene/liaisons/link_law.h"

namespace cordis::scene {

/// What a name of a scene stands for.
enum class Named : std::uint8_t { kMatter, kPort, kLinks };

/// Consecutive MATs or links.
struct IndexRun {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// A name and the MATs or links it stands for: consecutive ones, but for links that have no name of
/// their own. What belongs to a part is called part.name, and a copy of a repeated part is called
/// part[2].
struct NameEntry {
  std::string name;
  Named kind = Named::kMatter;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  bool sound = true;  ///< false: its description has a problem, so that nothing is said about its
                      ///< indices
  config::Place place;
  std::uint32_t copies = 0;         ///< repeated part: an index counts copies instead of MATs
  bool is_of_liaison = false;       ///< links without a name, called after their liaison
  std::vector<IndexRun> further{};  ///< runs of these that are not beside the first; in the count

  std::uint32_t index_count() const noexcept { return copies == 0 ? count : copies; }
  std::uint32_t per_index() const noexcept { return copies == 0 ? 1 : count / copies; }
  /// All it stands for, in its order.
  std::vector<IndexRun> runs() const;
};

/// A link as a name gives it: its kind and its index among those of its kind in one word.
constexpr std::uint32_t kLinkKindShift = 28;
constexpr std::uint32_t link_word(LinkKind kind, std::uint32_t index) noexcept {
  return (static_cast<std::uint32_t>(kind) << kLinkKindShift) | index;
}
constexpr LinkKind kind_of_link(std::uint32_t word) noexcept {
  return static_cast<LinkKind>(word >> kLinkKindShift);
}
constexpr std::uint32_t index_of_link(std::uint32_t word) noexcept {
  return word & ((1U << kLinkKindShift) - 1U);
}

/// The names of a scene. Matter, ports and named links share one list: no name stands for two
/// things. While a part is read its scope is entered: names in it are those of the part.
class Names {
 public:
  /// Enters a scope as long as it lives.
  class Scope {
   public:
    Scope(Names& names, const std::string& name) : names_(names), outer_(names.scope_) {
      names_.scope_ += name + ".";
    }
    ~Scope() { names_.scope_ = outer_; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Names& names_;
    std::string outer_;
  };

  /// Adds a name to the present scope; one that is taken is a problem of the entry's place.
  void add(NameEntry entry, config::Problems& problems);
  /// Adds links without a name to those of the same liaison, unless its name is taken. A name that is
  /// given later replaces it.
  void add_of_liaison(NameEntry entry);

  /// The name as it is called from outside of all parts.
  std::string full(const std::string& name) const { return scope_ + name; }

  /// An entry of the present scope; nullptr when there is none.
  const NameEntry* find(const std::string& name) const noexcept;
  /// What stands directly in the entry of this name, in the order of the indices; links do not.
  std::vector<const NameEntry*> children(const std::string& name) const;
  /// True if nothing has this name, but links have names that go on from it: those of a parallel
  /// liaison.
  bool is_before_links(const std::string& name) const noexcept;
  /// True if the name belongs to a part whose description has a problem.
  bool is_in_unsound(const std::string& name) const noexcept;
  /// For "did you mean": all but links of which there are none.
  std::vector<std::string> words(bool with_links) const;

  /// A MAT or a link as a selection writes it: string[3].
  std::string word_of(std::uint32_t index, bool is_link) const;

 private:
  std::map<std::string, NameEntry> entries_;  // by full name
  std::string scope_;
};

}  // namespace cordis::scene
