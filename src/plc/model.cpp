#include "src/plc/model.hpp"

#include <array>
#include <set>

namespace fieldproof::plc {

namespace {
constexpr bool read_only = false;
constexpr bool read_write = true;

// The 'Size' column of the manual holds for type H; the ranges of type S are smaller.
// U is flat: 32 words a slot, U07.31 is word 8 * 32 - 1 (Cnet KO 7.1.3).
constexpr std::array xbm_s{
    DeviceArea{'P', 128, read_write},      DeviceArea{'M', 256, read_write},
    DeviceArea{'K', 2560, read_write},     DeviceArea{'F', 256, read_only},
    DeviceArea{'T', 256, read_write, 256}, DeviceArea{'C', 256, read_write, 256},
    DeviceArea{'L', 1280, read_write},     DeviceArea{'N', 3936, read_only},
    DeviceArea{'D', 5120, read_write},     DeviceArea{'U', 8 * 32, read_write},
};

constexpr std::array xbc_h{
    DeviceArea{'P', 1024, read_write},       DeviceArea{'M', 1024, read_write},
    DeviceArea{'K', 4096, read_write},       DeviceArea{'F', 1024, read_only},
    DeviceArea{'T', 1024, read_write, 1024}, DeviceArea{'C', 1024, read_write, 1024},
    DeviceArea{'L', 2048, read_write},       DeviceArea{'N', 5120, read_only},
    DeviceArea{'D', 10240, read_write},      DeviceArea{'U', 11 * 32, read_write},
    DeviceArea{'R', 10240, read_write},
};

// %IW0.0.0 to %IW15.15.3: 16 bases of 16 slots of 4 words. %UW0.0.0 to %UW0.15.31: 16 slots of 32
// words.
constexpr std::array xec_h{
    DeviceArea{'I', 1024, read_write, 0, {16, 16, 4}},
    DeviceArea{'Q', 1024, read_write, 0, {16, 16, 4}},
    DeviceArea{'M', 8192, read_write},
    DeviceArea{'W', 10240, read_write, 0, {}, 'R'},  // FEnet A.1.2: "Same area as R"
    DeviceArea{'R', 10240, read_write},
    DeviceArea{'F', 1024, read_only},
    DeviceArea{'K', 4096, read_write},
    DeviceArea{'L', 2048, read_write},
    DeviceArea{'N', 5120, read_only},
    DeviceArea{'U', 512, read_write, 0, {1, 16, 32}},
};

constexpr std::array models{
    PlcModel{"xbc-h", false, xbc_h},
    PlcModel{"xbm-s", false, xbm_s, false},
    PlcModel{"xec-h", true, xec_h},
};
}  // namespace

const DeviceArea* PlcModel::area(char letter) const {
  for (const DeviceArea& a : areas) {
    if (a.letter == letter) return &a;
  }
  return nullptr;
}

std::span<const PlcModel> plc_models() { return models; }

const PlcModel* find_plc_model(std::string_view name) {
  for (const PlcModel& model : models) {
    if (model.name == name) return &model;
  }
  return nullptr;
}

std::vector<std::uint32_t> last_words_of(char letter) {
  std::set<std::uint32_t> ends;
  for (const PlcModel& model : models)
    if (const DeviceArea* area = model.area(letter)) ends.insert(area->last_word());
  return {ends.begin(), ends.end()};
}

std::string plc_model_names() {
  std::string names;
  for (const PlcModel& model : models)
    names += (names.empty() ? "" : ", ") + std::string(model.name);
  return names;
}

}  // namespace fieldproof::plc
