// tests/random_scenes/random_parts.h -- parts by chance, used once or in rows.
#pragma once

#include <cstdint>
#include <string>

namespace cordis::test {

/// Lines for the sections of a scene file; all of them are empty where a scene has no parts.
struct RandomParts {
  std::string parts;
  std::string matter;
  std::string liaisons;
  std::string links;
  std::string signals;
};

/// What liaisons of parts may have.
enum class PartLaws { kSprings, kDampedSprings, kAll };

/// One scene in four has a part: masses that a law joins, balls that touch each other and the MATs `p`. A row of
/// copies is shifted, turned and thrown. Some laws ask for a momentum or for the force of the contacts. Some parts have a port,
/// start by formulas, follow a function of time or are pushed as a whole.
/// A seed gives the same lines on every machine.
/// @param space  dimensions of the scene, 1 to 3
RandomParts random_parts(std::uint32_t seed, int space, PartLaws laws);

}  // namespace cordis::test
