// cli/scene_source/view_words.h -- the options that say how a scene is shown.
#pragma once

#include <optional>
#include <string>

#include "cli/command_line.h"
#include "viz_node/render/scene_painter.h"

namespace cordis::cli {

struct ViewWords {
  std::string camera;
  std::string theme;
  std::string colour;

  /// Each @throws UsageError for a word that is none.
  std::optional<viz::ViewPreset> preset() const;
  viz::Theme theme_or(viz::Theme usual) const;
  viz::ColourBy colour_by() const;
  /// Components and stretch are of links. @throws UsageError for a scene without any.
  void check_colour(const msg::SceneDescription& description) const;
};

/// @param theme  what is usual, for the help
void add_view_options(Verb& verb, ViewWords& words, const std::string& theme);

/// Reads a size as 1280x720; each even and between 64 and 8192. @throws UsageError
struct ImageSize {
  int width = 0;
  int height = 0;
};
ImageSize parse_size(const std::string& text);

}  // namespace cordis::cli
