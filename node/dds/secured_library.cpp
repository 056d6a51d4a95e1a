// node/dds/secured_library.cpp
#include "node/dds/secured_library.h"

#include <stdexcept>
#include <vector>

#include <dlfcn.h>
#include <fastdds/rtps/common/CDRMessage_t.h>
#include <fastdds/rtps/common/GuidPrefix_t.hpp>
#include <fastrtps/attributes/LibrarySettingsAttributes.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>

namespace eprosima::fastrtps::rtps::security {

/// The class of Fast DDS that encrypts the messages of a participant: the one member function of it
/// that Cordis checks. The library calls what the program defines under this name.
class SecurityManager {
 public:
  bool encode_rtps_message(const CDRMessage_t& message, CDRMessage_t& encrypted,
                           const std::vector<GuidPrefix_t>& receivers) const;
};

namespace {

using Encode = bool (*)(const SecurityManager*, const CDRMessage_t&, CDRMessage_t&,
                        const std::vector<GuidPrefix_t>&);

/// `SecurityManager::encode_rtps_message` of the library.
Encode encode_of_library() noexcept {
  static const Encode kEncode = reinterpret_cast<Encode>(
      dlsym(RTLD_NEXT,
            "_ZNK8eprosima8fastrtps4rtps8security15SecurityManager19encode_rtps_messageERKNS1_"
            "12CDRMessage_tERS4_RKSt6vectorINS1_12GuidPrefix_tESaIS9_EE"));
  return kEncode;
}

}  // namespace

/// Encrypts a message for its receivers. What waits for the thread that sends is sent without the
/// lock of its writer. When the last receiver leaves in between, the list is empty, and Fast DDS
/// 2.9.1 aborts. Such a message has no address to go to, so it needs no encryption.
bool SecurityManager::encode_rtps_message(const CDRMessage_t& message, CDRMessage_t& encrypted,
                                          const std::vector<GuidPrefix_t>& receivers) const {
  return receivers.empty() || encode_of_library()(this, message, encrypted, receivers);
}

}  // namespace eprosima::fastrtps::rtps::security

namespace cordis::dds {

void prepare_secured_library() {
  if (eprosima::fastrtps::rtps::security::encode_of_library() == nullptr)
    throw std::runtime_error("no keys with this version of Fast DDS: another encrypts messages");
  // A secured participant has a GUID that depends on its certificate. Fast DDS takes two processes
  // whose GUIDs begin alike for one, where messages need no socket, and loses them.
  eprosima::fastrtps::LibrarySettingsAttributes settings;
  settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
  eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
}

}  // namespace cordis::dds
