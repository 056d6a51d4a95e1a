// tests/fuzz/device.cpp -- device files. Their drivers are built, and none is started.
#include <cstdint>
#include <string>

#include "device_node/device_config.h"
#include "node/config/yaml_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cordis;
  config::Problems problems;
  problems.read_from({});
  const std::string text(reinterpret_cast<const char*>(data), size);
  const config::Value mapping = config::load_text(text, "input.yaml", problems);
  try {
    const device::LoadedDevice loaded = device::read_device(mapping, "input", problems);
    static_cast<void>(device::what_it_is(loaded.config));
    static_cast<void>(device::description_of(loaded.config));
  } catch (const config::ConfigError&) {
  }
  static_cast<void>(problems.text());
  return 0;
}
