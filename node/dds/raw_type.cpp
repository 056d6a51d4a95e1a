// node/dds/raw_type.cpp
#include "node/dds/raw_type.h"

#include <algorithm>
#include <cstring>

#include "node/cdr.h"

namespace cordis::dds {

namespace rtps = eprosima::fastrtps::rtps;

namespace {

constexpr std::uint32_t kUsualBytes = 512;  // room that a sample has before it has to grow

bool is_little_endian(const RawMessage& message) noexcept {
  return message.size() >= 2 && (message[1] & 1u) != 0;
}

}  // namespace

RawType::RawType(const std::string& name, bool keyed) {
  setName(name.c_str());
  m_typeSize = kUsualBytes;
  m_isGetKeyDefined = keyed;
  // Nothing is announced of the type but its name.
  auto_fill_type_object(false);
  auto_fill_type_information(false);
}

bool RawType::serialize(void* data, rtps::SerializedPayload_t* payload) {
  const RawMessage& message = *static_cast<const RawMessage*>(data);
  if (message.size() > payload->max_size) return false;
  std::ranges::copy(message, payload->data);
  payload->length = static_cast<std::uint32_t>(message.size());
  payload->encapsulation = is_little_endian(message) ? CDR_LE : CDR_BE;
  return true;
}

bool RawType::deserialize(rtps::SerializedPayload_t* payload, void* data) {
  static_cast<RawMessage*>(data)->assign(payload->data, payload->data + payload->length);
  return true;
}

std::function<std::uint32_t()> RawType::getSerializedSizeProvider(void* data) {
  return
      [data] { return static_cast<std::uint32_t>(static_cast<const RawMessage*>(data)->size()); };
}

void* RawType::createData() {
  return new RawMessage;
}

void RawType::deleteData(void* data) {
  delete static_cast<RawMessage*>(data);
}

bool RawType::getKey(void* data, rtps::InstanceHandle_t* handle, bool /*force_md5*/) {
  if (!m_isGetKeyDefined) return false;
  const std::uint32_t key = key_of(*static_cast<const RawMessage*>(data));
  *handle = rtps::InstanceHandle_t();
  // As the key of one number stands in an instance handle: big endian, then zeros [DDSI 9.6.3.8].
  for (int i = 0; i < 4; ++i) handle->value[i] = static_cast<rtps::octet>(key >> (24 - 8 * i));
  return true;
}

std::uint32_t key_of(const RawMessage& message) noexcept {
  if (message.size() < kEncapsulationBytes + 4) return 0;
  const std::uint8_t* bytes = message.data() + kEncapsulationBytes;
  std::uint32_t key = 0;
  for (int i = 0; i < 4; ++i)
    key |= static_cast<std::uint32_t>(bytes[i]) << (is_little_endian(message) ? 8 * i : 24 - 8 * i);
  return key;
}

}  // namespace cordis::dds
