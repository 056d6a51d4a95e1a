// sim_node/scene/writer/plain_liaisons.h -- the liaisons of a scene written out, parts of parallel ones as
// liaisons of their own.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "node/config/value.h"
#include "sim_node/scene/liaisons/liaison.h"

namespace cordis::scene {

/// A value as YAML, on one line.
std::string text_of(const config::Value& value);

/// The definitions of liaisons that links of a scene are made of, found one by one.
class PlainLiaisons {
 public:
  explicit PlainLiaisons(const Liaisons& liaisons) : liaisons_(liaisons) {}

  /// The name under which a liaison, or a part of a parallel one, is defined.
  /// Precondition: the scene has links made of it.
  std::string name_of(const std::string& liaison, const std::string& part);

  /// What a link may give to the liaison of that name. @param given  to the liaison it was part of
  GivenParameters given_to(const std::string& name, const GivenParameters& given) const;

  /// Lines of a `liaisons:` section: one for each that was asked for.
  std::string text() const;

 private:
  const Liaisons& liaisons_;
  std::map<std::pair<std::string, std::string>, std::string> names_;
  std::map<std::string, config::Value> definitions_;
};

}  // namespace cordis::scene
