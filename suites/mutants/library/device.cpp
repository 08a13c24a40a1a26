// What the library of mutated sources offers: devices. All else of it stays inside, so that nothing
// that judges them is mutated.
#include "harness/monitored_device.hpp"
#include "suites/mutants/mutated_devices.hpp"
#include "suites/protocols.hpp"

using namespace fieldproof;

extern "C" __attribute__((visibility("default"))) void fieldproof_make_device(
    std::string_view protocol, std::string_view model, const nlohmann::json& config,
    mutants::Made& made) {
  made = harness::make_monitored_device(*suites::protocols().find(protocol), model, config);
}
