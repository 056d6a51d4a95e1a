// sim_node/scene/language/name.cpp
#include "sim_node/scene/language/name.h"

#include <algorithm>

namespace cordis::scene {
namespace {

bool may_begin_a_name(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}

bool is_part_of_name(char c) {
  return may_begin_a_name(c) || (c >= '0' && c <= '9') || c == '-';
}

}  // namespace

bool check_name(const std::string& name, const config::Place& place, config::Problems& problems) {
  if (!name.empty() && may_begin_a_name(name[0]) &&
      std::all_of(name.begin(), name.end(), is_part_of_name))
    return true;
  problems.error(
      place,
      "a name is of letters, digits, '_' and '-' and begins with a letter, got '" + name + "'");
  return false;
}

}  // namespace cordis::scene
