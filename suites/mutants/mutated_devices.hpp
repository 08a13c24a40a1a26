// Our devices out of the library of mutated sources.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "src/plc/emulated_device.hpp"

namespace fieldproof::mutants {

using Made = std::optional<Result<std::unique_ptr<plc::EmulatedDevice>>>;

class MutatedDevices {
 public:
  using Make = void (*)(std::string_view, std::string_view, const nlohmann::json&, Made&);
  explicit MutatedDevices(Make function) : make_(function) {}

  Result<std::unique_ptr<plc::EmulatedDevice>> make(std::string_view protocol,
                                                    std::string_view model,
                                                    const nlohmann::json& config) const;

 private:
  Make make_;
};

/// The rest of this process is this mutant (0: the healthy device), and notes in `reached` by
/// number which others it comes by.
void become(int mutant, unsigned char* reached);

/// The devices, once the process has become a mutant: what they set up once, they do now.
using Load = std::function<Result<MutatedDevices>()>;
/// Errors are those of the loader.
Load from_library(const std::string& file);

}  // namespace fieldproof::mutants
