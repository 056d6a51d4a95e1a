// node/security/permissions.cpp
#include "node/security/permissions.h"

#include <string_view>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace cordis::node {
namespace {

// RTPS messages are encrypted as a whole: a third of what submessages and payloads cost.
constexpr const char* kGovernance = R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="omg_shared_ca_governance.xsd">
  <domain_access_rules>
    <domain_rule>
      <domains><id_range><min>0</min><max>232</max></id_range></domains>
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>NONE</discovery_protection_kind>
      <liveliness_protection_kind>NONE</liveliness_protection_kind>
      <rtps_protection_kind>ENCRYPT</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>false</enable_discovery_protection>
          <enable_liveliness_protection>false</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>NONE</metadata_protection_kind>
          <data_protection_kind>NONE</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
)";

// Fast DDS 2.9 takes the times of permissions for local ones, whatever the zone. The certificate
// has the exact times.
constexpr std::time_t kZones = 86'400;  // [s] that zones differ by, and more

std::string time_text(std::time_t time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(time));
}

std::string tags(std::string_view list, std::string_view one,
                 const std::vector<std::string>& values) {
  std::string text = fmt::format("<{}>", list);
  for (const std::string& value : values) text += fmt::format("<{0}>{1}</{0}>", one, value);
  return text + fmt::format("</{}>", list);
}

/// @param action  "publish" or "subscribe"
std::string criterion(std::string_view action, const std::vector<std::string>& topics,
                      const std::vector<std::string>& partitions) {
  if (topics.empty()) return {};
  return fmt::format("        <{0}>{1}{2}</{0}>\n", action, tags("topics", "topic", topics),
                     tags("partitions", "partition", partitions));
}

}  // namespace

std::string governance_text() {
  return kGovernance;
}

std::string subject_tag(const std::string& subject) {
  return "<subject_name>" + subject + "</subject_name>";
}

std::string permissions_text(Role role, const std::string& subject,
                             const std::vector<std::string>& sessions, const Validity& validity) {
  const RoleTopics topics = topics_of(role);
  const std::vector<std::string> partitions =
      sessions.empty() ? std::vector<std::string>{"*"} : sessions;
  return fmt::format(
      R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="omg_shared_ca_permissions.xsd">
  <permissions>
    <grant name="{}">
      {}
      <validity><not_before>{}</not_before><not_after>{}</not_after></validity>
      <allow_rule>
        <domains><id_range><min>0</min><max>232</max></id_range></domains>
{}{}      </allow_rule>
      <default>DENY</default>
    </grant>
  </permissions>
</dds>
)",
      role_word(role), subject_tag(subject), time_text(validity.from - kZones),
      time_text(validity.until + kZones), criterion("publish", topics.written, partitions),
      criterion("subscribe", topics.read, partitions));
}

}  // namespace cordis::node
