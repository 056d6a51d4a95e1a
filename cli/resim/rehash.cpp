// cli/resim/rehash.cpp
#include "cli/resim/rehash.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "idl/topics.h"
#include "node/dds/old_inputs.h"
#include "node/dds/payload.h"
#include "record_node/mcap/reader.h"
#include "record_node/mcap/writer.h"
#include "sim_node/engine/core/hash_version.h"

namespace cordis::cli {
namespace {

/// By epoch and number.
using ComputedFrames =
    std::map<std::pair<std::uint64_t, std::uint64_t>, const FrameCheck::Computed*>;

/// The payload of a frame as it is now, with as many fields as its take says: one of an older version
/// ends sooner.
std::vector<std::byte> renewed_frame(const mcap::Message& message, const ComputedFrames& frames) {
  msg::SceneFrame frame;
  const auto found =
      dds::decode(message.data, frame) ? frames.find({frame.epoch(), frame.frame()}) : frames.end();
  if (found == frames.end()) throw std::runtime_error("a frame of the take was not computed again");
  const FrameCheck::Computed& computed = *found->second;
  frame.position_hash(computed.position_hash);
  frame.position_m(computed.position_m);
  std::vector<std::byte> payload = dds::encode(frame);
  payload.resize(std::min(payload.size(), message.data.size()));
  return payload;
}

/// Likewise, in the layout of the take.
std::vector<std::byte> renewed_inputs(const mcap::Message& message) {
  msg::SceneInputs inputs;
  if (!dds::decode(message.data, inputs))
    throw std::runtime_error("a message of scene/inputs cannot be read");
  inputs.hash_version(engine::kHashVersion);
  inputs.engine_version(CORDIS_VERSION);
  return dds::is_old_inputs(message.data) ? dds::encode_old_inputs(inputs) : dds::encode(inputs);
}

void require(mcap::WriteStatus status, const mcap::Writer& writer) {
  if (status != mcap::WriteStatus::kOk) throw std::runtime_error(writer.problem());
}

/// @throws mcap::FileError or std::runtime_error with a sentence
void write_renewed(const mcap::Reader& old, const std::filesystem::path& renewed,
                   const ComputedFrames& frames) {
  mcap::Writer writer(renewed, {.sync = true});
  std::map<std::uint16_t, std::uint16_t> schemas{{0, 0}};
  for (const auto& [id, schema] : old.schemas()) schemas[id] = writer.add_schema(schema);
  std::map<std::uint16_t, std::uint16_t> channels;
  for (const auto& [id, channel] : old.channels()) {
    mcap::Channel copy = channel;
    copy.schema_id = schemas[channel.schema_id];
    channels[id] = writer.add_channel(copy);
  }
  for (const mcap::Attachment& attachment : old.attachments())
    require(writer.attach(attachment), writer);
  for (const mcap::Metadata& metadata : old.metadata())
    require(writer.add_metadata(metadata), writer);
  mcap::MessageCursor cursor = old.messages();
  for (mcap::Message message; cursor.next(message);) {
    const std::string& topic = old.channels().at(message.channel_id).topic;
    std::vector<std::byte> payload;
    if (topic == msg::TOPIC_FRAME) payload = renewed_frame(message, frames);
    if (topic == msg::TOPIC_INPUTS) payload = renewed_inputs(message);
    if (!payload.empty()) message.data = payload;
    message.channel_id = channels.at(message.channel_id);
    require(writer.write(message), writer);
  }
  if (!cursor.problems().empty()) throw std::runtime_error(cursor.problems().front());
  require(writer.close(), writer);
}

}  // namespace

void rehash(const std::string& take, const ResimResult& result) {
  if (result.other_lives > 0)
    throw std::runtime_error("sim_node restarted in the take: its lives cannot be renewed");
  ComputedFrames frames;
  for (const FrameCheck::Computed& computed : result.computed)
    frames[{computed.epoch, computed.frame}] = &computed;
  const mcap::Reader old(take);
  const std::filesystem::path renewed = take + ".renewed";
  std::filesystem::remove(mcap::part_of(renewed));
  std::filesystem::remove(renewed);
  try {
    write_renewed(old, renewed, frames);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(mcap::part_of(renewed), ignored);
    std::filesystem::remove(renewed, ignored);
    throw;
  }
  std::filesystem::rename(renewed, take);
}

}  // namespace cordis::cli
