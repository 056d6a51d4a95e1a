// sim_node/scene/sections/quantity_words.h -- the words that signals and conditions have for the
// variables of MATs, links and the scene.
#pragma once

#include <span>
#include <string>

#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

/// Whose a variable is.
enum class Owner { kMat, kBody, kLink, kStateLink, kMaxwellLink, kBend, kStateBend, kSet, kScene };

/// What a scene can ask for, of whom.
struct QuantityWord {
  const char* word;
  Owner owner;
  engine::VariableKind quantity;
  const char* unit;
  bool has_direction;
};

/// All words, those of one owner in the order in which messages list them.
std::span<const QuantityWord> quantity_words() noexcept;
/// What messages call an owner.
const char* name_of(Owner owner);
/// The owner of the quantities of a link. @param link  as names give it: link_word()
Owner owner_of(const engine::NetworkDescription& network, std::uint32_t link);
/// nullptr when the owner has no such quantity.
const QuantityWord* find_quantity(Owner owner, const std::string& word);
/// The words of MATs include those of a body.
std::string list_of_quantities(Owner owner);

/// Gives a variable of a MAT the direction that this MAT has by itself. It is that of a port of one
/// axis, whose rest is taken off a position, or the line of a scene in 1-D. @return false where
/// there is none
[[nodiscard]] bool take_own_direction(const Scene& scene, engine::Variable& variable);

}  // namespace cordis::scene
