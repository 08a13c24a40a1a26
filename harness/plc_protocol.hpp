// What a protocol has whose addresses are names of PLC memory ("%MW100"), whatever its frames are.
#pragma once

#include "harness/device_names.hpp"
#include "harness/protocol.hpp"
#include "src/plc/model.hpp"

namespace fieldproof::harness {

class PlcProtocol : public Protocol {
 public:
  /// nullptr: of no model in particular; the first stands for it.
  explicit PlcProtocol(const plc::PlcModel* model = nullptr) : model_(model) {}

  std::vector<std::string> models() const override;
  std::vector<Place> places(const Written& written) const override {
    return places_on(model(), written);
  }
  std::optional<Written> named(std::string_view address, std::size_t digits) const override {
    return named_memory(model(), address, digits);
  }
  std::optional<std::string> moved(std::string_view address, int words) const override {
    return moved_name(model(), address, words);
  }
  std::uint32_t words_of(std::string_view area) const override;
  std::optional<WordName> read_word(std::string_view text) const override {
    return read_word_name(text);
  }
  /// All that any model has.
  std::vector<Area> areas() const override;

 protected:
  const plc::PlcModel& model() const { return model_ ? *model_ : plc::plc_models().front(); }
  /// The one that was given, or nullptr.
  const plc::PlcModel* declared_model() const { return model_; }

 private:
  const plc::PlcModel* model_;
};

}  // namespace fieldproof::harness
