// viz_node/render/image.h -- pixels in memory, and as a PNG file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "viz_node/render/palette.h"

namespace cordis::viz {

/// Red, green and blue of each pixel, row by row from the top.
class Image {
 public:
  /// @param width, height  > 0
  Image(int width, int height, const Colour& colour);

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  const std::vector<std::uint8_t>& bytes() const noexcept { return bytes_; }
  std::uint8_t* pixel(int x, int y) noexcept {
    return bytes_.data() + 3 * (static_cast<std::size_t>(y) * width_ + x);
  }
  Colour at(int x, int y) const noexcept;
  void fill(const Colour& colour) noexcept;

  /// A 64-bit FNV-1a hash of the size and all pixels.
  std::uint64_t hash() const noexcept;

 private:
  int width_;
  int height_;
  std::vector<std::uint8_t> bytes_;
};

/// The bytes of a PNG file. @throws std::runtime_error when libpng refuses.
std::string png_of(const Image& image);

}  // namespace cordis::viz
