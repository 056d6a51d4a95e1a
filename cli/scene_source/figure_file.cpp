// cli/scene_source/figure_file.cpp
#include "cli/scene_source/figure_file.h"

#include <cmath>

#include "cli/command_line.h"
#include "cli/table/output_file.h"
#include "node/config/regular_file.h"
#include "viz_node/render/image.h"
#include "viz_node/render/pixel_canvas.h"
#include "viz_node/render/vector_canvas.h"

namespace cordis::cli {
namespace {

std::string figure_bytes(const std::string& path, double width, double height,
                         const viz::Colour& background,
                         const std::function<void(viz::Canvas&)>& draw) {
  if (path.ends_with(".svg")) {
    viz::SvgCanvas canvas(width, height, background);
    draw(canvas);
    return canvas.text();
  }
  if (path.ends_with(".pdf")) {
    viz::PdfCanvas canvas(width, height, background);
    draw(canvas);
    return canvas.bytes();
  }
  viz::PixelCanvas canvas(static_cast<int>(std::ceil(width)), static_cast<int>(std::ceil(height)),
                          background);
  draw(canvas);
  return viz::png_of(canvas.image());
}

}  // namespace

void check_figure_file(const std::string& path) {
  if (path.empty()) throw UsageError("say where to: -o figure.svg, .pdf or .png");
  if (!path.ends_with(".svg") && !path.ends_with(".pdf") && !path.ends_with(".png"))
    throw UsageError("-o '" + path + "' is no figure: name a file .svg, .pdf or .png");
  const std::string reason = config::reason_not_to_write(path);
  if (!reason.empty()) throw UsageError("cannot write " + path + ": " + reason);
}

void write_figure(const std::string& path, double width, double height,
                  const viz::Colour& background, const std::function<void(viz::Canvas&)>& draw) {
  OutputFile file(path);
  file.write(figure_bytes(path, width, height, background, draw));
  file.flush();
}

}  // namespace cordis::cli
