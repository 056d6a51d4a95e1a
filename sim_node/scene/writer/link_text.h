// sim_node/scene/writer/link_text.h -- the links of a scene and their liaisons written in its language
// again.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "sim_node/scene/scene.h"
#include "sim_node/scene/writer/plain_liaisons.h"
#include "sim_node/scene/writer/scene_words.h"

namespace cordis::scene {

/// Lines of the sections `links:` and `liaisons:`, and the words by which signals call the links.
class LinkText {
 public:
  /// @param scene, words  outlive it
  LinkText(const Scene& scene, SceneWords& words);

  /// Links one after the other, as many in an entry as have one law; then those of sets. Couplings
  /// stand with their ports.
  std::string links();
  /// Of the links written before.
  std::string liaisons() const;
  /// Of a link written before that a signal tells of.
  const std::string& word_of(LinkKind kind, std::uint32_t index) const {
    return link_words_.at({kind, index});
  }
  /// Of a named liaison of sets written before.
  const std::string& word_of_set(std::uint32_t index) const { return set_words_.at(index); }

 private:
  struct WrittenLink;

  std::string own_liaison(std::string name) const;
  WrittenLink written(const LinkGroup& group, std::uint32_t index);
  std::string given_text(const std::string& liaison, const std::string& part,
                         const GivenParameters& given);
  bool has_signal(const LinkGroup& group) const;
  std::string entry_text(const LinkGroup& group, std::uint32_t& next);
  std::string sets();

  const Scene& scene_;
  const engine::NetworkDescription& network_;
  SceneWords& words_;
  PlainLiaisons liaisons_;
  std::string linear_;   // name of the liaison of all linear links
  std::string maxwell_;  // and of all Maxwell elements
  std::map<std::pair<LinkKind, std::uint32_t>, std::string> link_words_;
  std::map<std::uint32_t, std::string> set_words_;
};

}  // namespace cordis::scene
