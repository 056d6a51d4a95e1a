// node/dds/library_faults.cpp
#include "node/dds/library_faults.h"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <vector>

#include <dlfcn.h>
#include <fastdds/rtps/builtin/data/ReaderProxyData.h>
#include <fastdds/rtps/common/CDRMessage_t.h>
#include <fastdds/rtps/common/CacheChange.h>
#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/GuidPrefix_t.hpp>
#include <fastdds/rtps/common/SequenceNumber.h>
#include <fastdds/rtps/messages/RTPSMessageGroup.h>
#include <fastdds/rtps/messages/RTPSMessageSenderInterface.hpp>
#include <fastdds/rtps/writer/RTPSWriter.h>
#include <fastdds/rtps/writer/ReaderProxy.h>
#include <fastdds/rtps/writer/StatefulWriter.h>

// Classes of Fast DDS that it does not publish: the member functions of them that are checked here.
namespace eprosima::fastrtps::rtps::security {
class SecurityManager {
 public:
  bool encode_rtps_message(const CDRMessage_t& message, CDRMessage_t& encrypted,
                           const std::vector<GuidPrefix_t>& receivers) const;
};
}  // namespace eprosima::fastrtps::rtps::security
namespace eprosima::fastrtps::rtps {
class WriterProxy {
 public:
  int lost_changes_update(const SequenceNumber_t& first);
  SequenceNumber_t available_changes_max() const;
  void loaded_from_storage(const SequenceNumber_t& last);
};
}  // namespace eprosima::fastrtps::rtps
namespace eprosima::fastdds::dds {
class DataWriterImpl {
 public:
  class InnerDataWriterListener {
   public:
    // NOLINTNEXTLINE(readability-identifier-naming)
    void onWriterChangeReceivedByAll(fastrtps::rtps::RTPSWriter* writer,
                                     fastrtps::rtps::CacheChange_t* change);
  };
};
}  // namespace eprosima::fastdds::dds

namespace {

namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastdds::dds::DataWriterImpl;
using rtps::security::SecurityManager;

/// The functions of the library itself; null where it has none.
struct OfLibrary {
  bool (*encode)(const SecurityManager*, const rtps::CDRMessage_t&, rtps::CDRMessage_t&,
                 const std::vector<rtps::GuidPrefix_t>&);
  bool (*remove_reader)(rtps::StatefulWriter*, const rtps::GUID_t&);
  void (*received_by_all)(DataWriterImpl::InnerDataWriterListener*, rtps::RTPSWriter*,
                          rtps::CacheChange_t*);
  bool (*insert)(rtps::RTPSMessageGroup*, const rtps::GuidPrefix_t&, bool);
  int (*lose)(rtps::WriterProxy*, const rtps::SequenceNumber_t&);
  bool (*update)(rtps::ReaderProxy*, const rtps::ReaderProxyData&);
};

template <class Function>
void find(const char* name, Function& function) noexcept {
  function = reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

const OfLibrary& of_library() noexcept {
  static const OfLibrary kFound = [] {
    OfLibrary found{};
    find(
        "_ZNK8eprosima8fastrtps4rtps8security15SecurityManager19encode_rtps_messageERKNS1_"
        "12CDRMessage_tERS4_RKSt6vectorINS1_12GuidPrefix_tESaIS9_EE",
        found.encode);
    find("_ZN8eprosima8fastrtps4rtps14StatefulWriter21matched_reader_removeERKNS1_6GUID_tE",
         found.remove_reader);
    find(
        "_ZN8eprosima7fastdds3dds14DataWriterImpl23InnerDataWriterListener"
        "27onWriterChangeReceivedByAllEPNS_8fastrtps4rtps10RTPSWriterEPNS5_13CacheChange_tE",
        found.received_by_all);
    find(
        "_ZN8eprosima8fastrtps4rtps16RTPSMessageGroup17insert_submessageERKNS1_"
        "12GuidPrefix_tEb",
        found.insert);
    find("_ZN8eprosima8fastrtps4rtps11WriterProxy19lost_changes_updateERKNS1_16SequenceNumber_tE",
         found.lose);
    find("_ZN8eprosima8fastrtps4rtps11ReaderProxy6updateERKNS1_15ReaderProxyDataE", found.update);
    return found;
  }();
  return kFound;
}

// What encryption adds to a message: a prefix, a header, a body, padding and a postfix with a tag.
// Each receiver has a tag of its own. Fast DDS appends room for statistics at last.
constexpr std::size_t kEncryptionBytes = 68;
constexpr std::size_t kBytesOfReceiver = 20;
constexpr std::size_t kMoreReceivers = 10;  // that may come before it is sent
constexpr std::size_t kStatisticsBytes = 60;

/// True while this thread takes a receiver out of a writer.
thread_local bool a_receiver_leaves = false;

}  // namespace

/// Encrypts a message for its receivers. What waits for the thread that sends is sent without the
/// lock of its writer. When the last receiver leaves in between, the list is empty, and Fast DDS
/// 2.9.1 aborts. Such a message has no address to go to, so it needs no encryption.
bool SecurityManager::encode_rtps_message(const rtps::CDRMessage_t& message,
                                          rtps::CDRMessage_t& encrypted,
                                          const std::vector<rtps::GuidPrefix_t>& receivers) const {
  return receivers.empty() || of_library().encode(this, message, encrypted, receivers);
}

/// Adds a part to a message. Where it would not fit when encrypted, the message is sent first: Fast
/// DDS 2.9.1 fills it up, then loses it or aborts.
bool rtps::RTPSMessageGroup::insert_submessage(const GuidPrefix_t& receiver, bool is_big) {
  const bool is_begun = full_msg_->length > RTPSMESSAGE_HEADER_SIZE;
  if (is_begun && encrypt_msg_ != nullptr) {
    std::size_t receivers = kMoreReceivers;
    {
      const std::lock_guard lock(*sender_);
      receivers += sender_->remote_participants().size();
    }
    const std::size_t length = std::size_t{full_msg_->length} + submessage_msg_->length +
                               kEncryptionBytes + kBytesOfReceiver * receivers + kStatisticsBytes;
    if (length > full_msg_->max_size) {
      flush_and_reset();
      add_info_dst_in_buffer(full_msg_, receiver);
    }
  }
  return of_library().insert(this, receiver, is_big);
}

/// Drops samples of a writer that are gone before this one. Where they are many, none of them is waited for: Fast DDS
/// 2.9.1 counts through their numbers one by one, with the lock of the reader, for 2^61 of them without an end.
int rtps::WriterProxy::lost_changes_update(const SequenceNumber_t& first) {
  constexpr std::uint64_t kMany = 65'536;
  const std::uint64_t before = available_changes_max().to64long();
  const int lost = of_library().lose(this, first);
  if (first.to64long() > before + kMany) loaded_from_storage(available_changes_max());
  return lost;
}

/// Takes the new description of a reader. Reliability never changes [DDS 2.2.3]: a reader that describes another one
/// stays what it was. Fast DDS 2.9.1 takes it without the timers of a reliable reader, and aborts at the next sample.
bool rtps::ReaderProxy::update(const ReaderProxyData& said) {
  const bool says_reliable =
      said.m_qos.m_reliability.kind != eprosima::fastdds::dds::BEST_EFFORT_RELIABILITY_QOS;
  return says_reliable == is_reliable() && of_library().update(this, said);
}

bool rtps::StatefulWriter::matched_reader_remove(const GUID_t& reader) {
  a_receiver_leaves = true;
  const bool removed = of_library().remove_reader(this, reader);
  a_receiver_leaves = false;
  return removed;
}

/// Removes a message that all receivers have, unless one of them is just taken out: then the lock of
/// its addresses is held, which the thread that sends may wait for with the lock of all messages.
void DataWriterImpl::InnerDataWriterListener::onWriterChangeReceivedByAll(
    fastrtps::rtps::RTPSWriter* writer, fastrtps::rtps::CacheChange_t* change) {
  if (!a_receiver_leaves) of_library().received_by_all(this, writer, change);
}

namespace cordis::dds {

void take_out_library_faults() {
  const OfLibrary& found = of_library();
  if (found.encode == nullptr || found.remove_reader == nullptr ||
      found.received_by_all == nullptr || found.insert == nullptr || found.lose == nullptr ||
      found.update == nullptr) {
    throw std::runtime_error(
        "this library of Fast DDS lacks functions that Cordis checks: install libfastrtps2.9");
  }
}

}  // namespace cordis::dds
