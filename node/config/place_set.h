// node/config/place_set.h -- places of files of which each counts once.
#pragma once

#include <set>
#include <string>
#include <tuple>

#include "node/config/problem.h"

namespace cordis::config {

/// Places of files. What stands at one place, such as the copies of a part, has one problem.
class PlaceSet {
 public:
  /// @return false where the place is in it already.
  bool add(const Place& place) {
    return places_.emplace(place.file, place.line, place.column).second;
  }
  bool has(const Place& place) const {
    return places_.contains({place.file, place.line, place.column});
  }

 private:
  std::set<std::tuple<std::string, int, int>> places_;
};

}  // namespace cordis::config
