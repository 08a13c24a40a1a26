#include "suites/mutants/mutated_devices.hpp"

#include <dlfcn.h>

// The library finds these in the program that loads it (mutant.hpp).
extern "C" {
__attribute__((visibility("default"))) int fieldproof_mutant = 0;
__attribute__((visibility("default"))) unsigned char* fieldproof_reached = nullptr;
}

namespace fieldproof::mutants {

void become(int mutant, unsigned char* reached) {
  fieldproof_mutant = mutant;
  fieldproof_reached = reached;
}

Load from_library(const std::string& file) {
  return [file]() -> Result<MutatedDevices> {
    void* const handle = ::dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
    void* const make = handle ? ::dlsym(handle, "fieldproof_make_device") : nullptr;
    if (!make) return fail(std::string("cannot load the mutated devices: ") + ::dlerror());
    return MutatedDevices(reinterpret_cast<MutatedDevices::Make>(make));
  };
}

Result<std::unique_ptr<plc::EmulatedDevice>> MutatedDevices::make(
    std::string_view protocol, std::string_view model, const nlohmann::json& config) const {
  Made made;
  make_(protocol, model, config, made);
  return std::move(*made);
}

}  // namespace fieldproof::mutants
