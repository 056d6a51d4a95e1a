// viz_node/render/image.cpp
#include "viz_node/render/image.h"

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include <zlib.h>

namespace cordis::viz {
namespace {

constexpr int kLevel = 6;  // of compression: more takes twice the time for 2 % of the size

void put_number(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255u);
}

void put_chunk(std::string& file, std::string_view type, const std::string& data) {
  put_number(file, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = file.size();
  file += type;
  file += data;
  const auto* bytes = reinterpret_cast<const Bytef*>(file.data() + begin);
  put_number(file,
             static_cast<std::uint32_t>(crc32(0, bytes, static_cast<uInt>(file.size() - begin))));
}

int paeth(int left, int up, int corner) noexcept {
  const int guess = left + up - corner;
  const int to_left = std::abs(guess - left);
  const int to_up = std::abs(guess - up);
  const int to_corner = std::abs(guess - corner);
  if (to_left <= to_up && to_left <= to_corner) return left;
  return to_up <= to_corner ? up : corner;
}

/// A row as its differences from a guess, by the filters of PNG: 0 none, 1 left, 2 up, 4 Paeth.
void filter_row(int filter, const std::uint8_t* row, const std::uint8_t* above, std::size_t size,
                std::string& out) {
  out.assign(1, static_cast<char>(filter));
  for (std::size_t i = 0; i < size; ++i) {
    const int left = i >= 3 ? row[i - 3] : 0;
    const int up = above != nullptr ? above[i] : 0;
    const int corner = i >= 3 && above != nullptr ? above[i - 3] : 0;
    const int guess = filter == 0   ? 0
                      : filter == 1 ? left
                      : filter == 2 ? up
                                    : paeth(left, up, corner);
    out += static_cast<char>(row[i] - guess);
  }
}

long weight_of(const std::string& row) noexcept {
  long weight = 0;
  for (std::size_t i = 1; i < row.size(); ++i) weight += std::abs(static_cast<signed char>(row[i]));
  return weight;
}

/// The rows, each with the filter that leaves the smallest differences.
std::string filtered(const Image& image) {
  const std::size_t size = 3 * static_cast<std::size_t>(image.width());
  std::string rows;
  std::string best;
  std::string candidate;
  for (int y = 0; y < image.height(); ++y) {
    const std::uint8_t* row = image.bytes().data() + size * y;
    const std::uint8_t* above = y > 0 ? row - size : nullptr;
    long lightest = -1;
    for (const int filter : {0, 1, 2, 4}) {
      filter_row(filter, row, above, size, candidate);
      const long weight = weight_of(candidate);
      if (lightest >= 0 && weight >= lightest) continue;
      lightest = weight;
      best.swap(candidate);
    }
    rows += best;
  }
  return rows;
}

std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                kLevel) != Z_OK) {
    throw std::runtime_error("zlib refuses the pixels");
  }
  out.resize(size);
  return out;
}

}  // namespace

Image::Image(int width, int height, const Colour& colour)
    : width_(width), height_(height), bytes_(3 * static_cast<std::size_t>(width) * height) {
  fill(colour);
}

Colour Image::at(int x, int y) const noexcept {
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
  std::string file = "\x89PNG\r\n\x1a\n";
  std::string header;
  put_number(header, static_cast<std::uint32_t>(image.width()));
  put_number(header, static_cast<std::uint32_t>(image.height()));
  header += std::string("\x08\x02\x00\x00\x00", 5);  // 8 bits, colours, no interlacing
  put_chunk(file, "IHDR", header);
  put_chunk(file, "IDAT", compressed(filtered(image)));
  put_chunk(file, "IEND", "");
  return file;
}

}  // namespace cordis::viz
