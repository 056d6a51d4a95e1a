// cli/resim/take_reader.cpp
#include "cli/resim/take_reader.h"

#include <set>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "idl/topics.h"
#include "node/config/count_text.h"
#include "node/dds/payload.h"

namespace cordis::cli {

TakeReader::TakeReader(const std::string& path)
    : file_(path),
      inputs_(file_.messages({.topics = {msg::TOPIC_INPUTS}})),
      frames_(file_.messages({.topics = {msg::TOPIC_FRAME}})) {
  choose_epoch();
  read_descriptions();
}

void TakeReader::choose_epoch() {
  mcap::MessageCursor cursor = file_.messages({.topics = {msg::TOPIC_INPUTS}});
  std::set<std::uint64_t> epochs;
  std::uint64_t first = 0;
  std::uint64_t complete = 0;
  mcap::Message message;
  msg::SceneInputs batch;
  while (cursor.next(message)) {
    if (!dds::decode(message.data, batch)) continue;
    epochs.insert(batch.epoch());
    if (first == 0) first = batch.epoch();
    if (complete == 0 && batch.batch() == 1) complete = batch.epoch();
  }
  if (epochs.empty()) {
    throw std::invalid_argument(file_.path().string() + " has no inputs: " +
                                (file_.is_whole() ? "it was recorded without " + msg::TOPIC_INPUTS +
                                                        ", or by an older version"
                                                  : file_.damage()));
  }
  epoch_ = complete != 0 ? complete : first;
  other_epochs_ = epochs.size() - 1;
}

void TakeReader::read_descriptions() {
  mcap::MessageCursor cursor = file_.messages({.topics = {msg::TOPIC_DESCRIPTION}});
  mcap::Message message;
  msg::SceneDescription description;
  while (cursor.next(message)) {
    if (!dds::decode(message.data, description) || description.epoch() != epoch_) continue;
    descriptions_[description.version()] = description;
  }
}

template <class Message>
bool TakeReader::read(mcap::MessageCursor& cursor, Message& message) {
  mcap::Message raw;
  while (cursor.next(raw)) {
    if (!dds::decode(raw.data, message)) {
      ++unreadable_;
      continue;
    }
    if (message.epoch() == epoch_) return true;
    if constexpr (std::is_same_v<Message, msg::SceneFrame>) ++other_frames_;
  }
  return false;
}

bool TakeReader::next(msg::SceneInputs& batch) {
  return numbered_inputs_.next([this](msg::SceneInputs& one) { return read(inputs_, one); },
                               [](const msg::SceneInputs& one) { return one.batch(); }, batch);
}

bool TakeReader::next(msg::SceneFrame& frame) {
  const auto read_frame = [this](msg::SceneFrame& one) { return read(frames_, one); };
  const auto number = [](const msg::SceneFrame& one) { return one.frame(); };
  while (numbered_frames_.next(read_frame, number, frame)) {
    if (frame.frame() <= newest_frame_) continue;  // received twice
    newest_frame_ = frame.frame();
    return true;
  }
  return false;
}

const msg::SceneDescription* TakeReader::description(std::uint64_t version) const noexcept {
  const auto found = descriptions_.find(version);
  return found == descriptions_.end() ? nullptr : &found->second;
}

std::string TakeReader::loss() const {
  std::string text = file_.damage();
  for (const mcap::MessageCursor* cursor : {&inputs_, &frames_}) {
    for (const std::string& problem : cursor->problems()) {
      if (text.find(problem) == std::string::npos) text += (text.empty() ? "" : "; ") + problem;
    }
  }
  if (unreadable_ > 0) {
    text +=
        (text.empty() ? "" : "; ") + config::count_text(unreadable_, "message") + " cannot be read";
  }
  return text;
}

}  // namespace cordis::cli
