// node/dds/raw_type.h -- a type of DDS whose messages stay the bytes that they are on the wire.
// Included by node/dds alone.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/rtps/common/InstanceHandle.h>
#include <fastdds/rtps/common/SerializedPayload.h>

namespace cordis::dds {

/// A message as it is on the wire: 4 bytes that say how it is encoded, then its members.
using RawMessage = std::vector<std::uint8_t>;

/// Stands for a type of that name, of which nothing else is known. The key of a keyed one is taken
/// to be an `unsigned long` and the first member, as in all types of Cordis.
class RawType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  RawType(const std::string& name, bool keyed);

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override;
  void deleteData(void* data) override;
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle,
              bool force_md5) override;
};

/// The key of a message as RawType understands it; 0 when it is too short to have one.
std::uint32_t key_of(const RawMessage& message) noexcept;

}  // namespace cordis::dds
