// record_node/mcap/compression.cpp
#include "record_node/mcap/compression.h"

#include <new>

#include <lz4frame.h>
#include <zstd.h>

namespace cordis::mcap {
namespace {

constexpr int kZstdLevel = 1;  // a recorder has no time for more

std::string decompress_lz4(LZ4F_dctx* context, std::span<const std::byte> packed,
                           std::span<std::byte> out) {
  LZ4F_resetDecompressionContext(context);
  std::size_t hint = 1;
  while (!packed.empty() && hint != 0) {
    std::size_t written = out.size();
    std::size_t taken = packed.size();
    std::byte nothing{};
    std::byte* target = out.empty() ? &nothing : out.data();
    hint = LZ4F_decompress(context, target, &written, packed.data(), &taken, nullptr);
    if (LZ4F_isError(hint) != 0) return LZ4F_getErrorName(hint);
    if (written == 0 && taken == 0) return "it holds more than it says";
    out = out.subspan(written);
    packed = packed.subspan(taken);
  }
  if (hint != 0) return "it ends too early";
  return out.empty() && packed.empty() ? "" : "its size is not what it says";
}

}  // namespace

const char* name_of(Compression compression) {
  if (compression == Compression::kLz4) return "lz4";
  return compression == Compression::kZstd ? "zstd" : "";
}

std::optional<Compression> compression_named(const std::string& name) {
  if (name.empty() || name == "none") return Compression::kNone;
  if (name == "lz4") return Compression::kLz4;
  if (name == "zstd") return Compression::kZstd;
  return std::nullopt;
}

struct Compressor::Contexts {
  ZSTD_CCtx* zstd = ZSTD_createCCtx();
  Contexts() {
    if (zstd == nullptr) throw std::bad_alloc();
  }
  ~Contexts() { ZSTD_freeCCtx(zstd); }
  Contexts(const Contexts&) = delete;
  Contexts& operator=(const Contexts&) = delete;
};

Compressor::Compressor(Compression compression)
    : compression_(compression), contexts_(std::make_unique<Contexts>()) {}
Compressor::~Compressor() = default;

bool Compressor::compress(std::span<const std::byte> records, Bytes& out) {
  if (compression_ == Compression::kNone) {
    out.assign(records.begin(), records.end());
    return true;
  }
  if (compression_ == Compression::kZstd) {
    out.resize(ZSTD_compressBound(records.size()));
    const std::size_t size = ZSTD_compressCCtx(contexts_->zstd, out.data(), out.size(),
                                               records.data(), records.size(), kZstdLevel);
    if (ZSTD_isError(size) != 0) return false;
    out.resize(size);
    return true;
  }
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.contentSize = records.size();
  out.resize(LZ4F_compressFrameBound(records.size(), &preferences));
  const std::size_t size =
      LZ4F_compressFrame(out.data(), out.size(), records.data(), records.size(), &preferences);
  if (LZ4F_isError(size) != 0) return false;
  out.resize(size);
  return true;
}

struct Decompressor::Contexts {
  ZSTD_DCtx* zstd = ZSTD_createDCtx();
  LZ4F_dctx* lz4 = nullptr;
  Contexts() {
    if (zstd == nullptr || LZ4F_isError(LZ4F_createDecompressionContext(&lz4, LZ4F_VERSION)) != 0)
      throw std::bad_alloc();
  }
  ~Contexts() {
    ZSTD_freeDCtx(zstd);
    LZ4F_freeDecompressionContext(lz4);
  }
  Contexts(const Contexts&) = delete;
  Contexts& operator=(const Contexts&) = delete;
};

Decompressor::Decompressor() : contexts_(std::make_unique<Contexts>()) {}
Decompressor::~Decompressor() = default;

std::string Decompressor::decompress(const std::string& compression,
                                     std::span<const std::byte> packed, std::uint64_t size,
                                     Bytes& out) {
  const auto kind = compression_named(compression);
  if (!kind) return "its compression is not known: '" + compression.substr(0, 16) + "'";
  if (size > kMaxChunkSize)
    return "it unpacks to " + std::to_string(size) + " bytes, more than is read at once";
  if (kind == Compression::kNone) {
    if (packed.size() != size) return "its size is not what it says";
    out.assign(packed.begin(), packed.end());
    return {};
  }
  out.resize(size);
  if (kind == Compression::kLz4) return decompress_lz4(contexts_->lz4, packed, out);
  const std::size_t got =
      ZSTD_decompressDCtx(contexts_->zstd, out.data(), out.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) != 0) return ZSTD_getErrorName(got);
  return got == size ? "" : "its size is not what it says";
}

}  // namespace cordis::mcap
