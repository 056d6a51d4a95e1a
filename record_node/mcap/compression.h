// record_node/mcap/compression.h -- how the records of a chunk are packed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "record_node/mcap/byte_writer.h"

namespace cordis::mcap {

enum class Compression : std::uint8_t { kNone, kLz4, kZstd };

/// Chunks that unpack to more are not read: a small hostile file could take all memory [bytes].
inline constexpr std::uint64_t kMaxChunkSize = std::uint64_t{256} << 20;

/// What MCAP calls it: "", "lz4", "zstd".
const char* name_of(Compression compression);
/// Understands "none" and "" alike; none for any other word.
std::optional<Compression> compression_named(const std::string& name);

/// Packs chunks; keeps its memory from one to the next.
class Compressor {
 public:
  explicit Compressor(Compression compression);
  ~Compressor();
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  Compression compression() const noexcept { return compression_; }
  /// Replaces `out`. @return false when the library behind it fails
  bool compress(std::span<const std::byte> records, Bytes& out);

 private:
  struct Contexts;
  Compression compression_;
  std::unique_ptr<Contexts> contexts_;
};

/// Unpacks chunks; keeps its memory from one to the next.
class Decompressor {
 public:
  Decompressor();
  ~Decompressor();
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  /// Replaces `out`. @param size  what the records must unpack to
  /// @return what is wrong; empty when `out` holds exactly `size` bytes
  std::string decompress(const std::string& compression, std::span<const std::byte> packed,
                         std::uint64_t size, Bytes& out);

 private:
  struct Contexts;
  std::unique_ptr<Contexts> contexts_;
};

}  // namespace cordis::mcap
