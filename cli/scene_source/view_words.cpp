// cli/scene_source/view_words.cpp
#include "cli/scene_source/view_words.h"

#include "cli/number.h"

namespace cordis::cli {
namespace {

constexpr int kMinPixels = 64;  // [pixels]
constexpr int kMaxPixels = 8192;

}  // namespace

std::optional<viz::ViewPreset> ViewWords::preset() const {
  if (camera.empty()) return std::nullopt;
  if (camera == "front") return viz::ViewPreset::kFront;
  if (camera == "side") return viz::ViewPreset::kSide;
  if (camera == "top") return viz::ViewPreset::kTop;
  if (camera == "free") return viz::ViewPreset::kFree;
  throw UsageError("--camera is front, side, top or free, not '" + camera + "'");
}

viz::Theme ViewWords::theme_or(viz::Theme usual) const {
  if (theme.empty()) return usual;
  if (theme == "dark") return viz::Theme::kDark;
  if (theme == "light") return viz::Theme::kLight;
  throw UsageError("--theme is dark or light, not '" + theme + "'");
}

viz::ColourBy ViewWords::colour_by() const {
  if (colour.empty() || colour == "body") return viz::ColourBy::kBody;
  if (colour == "speed") return viz::ColourBy::kSpeed;
  if (colour == "force") return viz::ColourBy::kForce;
  if (colour == "components") return viz::ColourBy::kComponents;
  if (colour == "stretch") return viz::ColourBy::kStretch;
  throw UsageError("--colour is body, speed, force, components or stretch, not '" + colour + "'");
}

void ViewWords::check_colour(const msg::SceneDescription& description) const {
  const viz::ColourBy what = colour_by();
  const bool is_of_links = what == viz::ColourBy::kComponents || what == viz::ColourBy::kStretch;
  if (is_of_links && description.link_ends().empty())
    throw UsageError("--colour " + colour + " is of links, and this scene has none");
}

void add_view_options(Verb& verb, ViewWords& words, const std::string& theme) {
  verb.option("--camera", "VIEW", words.camera,
              "front, side, top or free [front; free for a scene in space]");
  verb.option("--colour", "WHAT", words.colour,
              "Colours say body, speed, force, components or stretch [body]");
  verb.option("--theme", "THEME", words.theme, "dark or light [" + theme + "]");
}

ImageSize parse_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos)
    throw UsageError("--size is a width and a height as 1280x720, not '" + text + "'");
  const ImageSize size{
      parse_whole_number("--size", text.substr(0, cross), kMinPixels, kMaxPixels),
      parse_whole_number("--size", text.substr(cross + 1), kMinPixels, kMaxPixels)};
  if (size.width % 2 != 0 || size.height % 2 != 0)
    throw UsageError("--size " + text + ": films have an even width and height");
  return size;
}

}  // namespace cordis::cli
