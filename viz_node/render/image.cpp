// viz_node/render/image.cpp
#include "viz_node/render/image.h"

#include <stdexcept>

#include <png.h>

#include "node/assert.h"

namespace cordis::viz {
Image::Image(int width, int height, const Colour& colour)
    : width_(width), height_(height), bytes_(3 * static_cast<std::size_t>(width) * height) {
  CORDIS_ASSERT(width > 0 && height > 0);
  fill(colour);
}

Colour Image::at(int x, int y) const noexcept {
  CORDIS_ASSERT(x >= 0 && x < width_ && y >= 0 && y < height_);
  const std::uint8_t* pixel = bytes_.data() + 3 * (static_cast<std::size_t>(y) * width_ + x);
  return {pixel[0], pixel[1], pixel[2]};
}

void Image::fill(const Colour& colour) noexcept {
  for (std::size_t i = 0; i < bytes_.size(); i += 3) {
    bytes_[i] = colour.red;
    bytes_[i + 1] = colour.green;
    bytes_[i + 2] = colour.blue;
  }
}

std::uint64_t Image::hash() const noexcept {
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&hash](std::uint8_t byte) { hash = (hash ^ byte) * 1099511628211u; };
  for (const int size : {width_, height_}) {
    for (int shift = 0; shift < 32; shift += 8) add(static_cast<std::uint8_t>(size >> shift));
  }
  for (const std::uint8_t byte : bytes_) add(byte);
  return hash;
}

std::string png_of(const Image& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width());
  header.height = static_cast<png_uint_32>(image.height());
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string file(size, '\0');
  if (png_image_write_to_memory(&header, file.data(), &size, 0, image.bytes().data(), 0, nullptr) ==
      0)
    throw std::runtime_error(std::string("libpng refuses an image: ") + header.message);
  file.resize(size);
  return file;
}

}  // namespace cordis::viz
