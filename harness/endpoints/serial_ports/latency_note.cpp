#include "harness/endpoints/serial_ports/latency_note.hpp"

#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

namespace fieldproof::endpoints {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string start_of_the_system() {
  std::ifstream stream("/proc/sys/kernel/random/boot_id");
  std::string id;
  std::getline(stream, id);
  return id;
}

std::optional<bool> flag_of(const json& note, const char* key) {
  const auto found = note.find(key);
  return found != note.end() && found->is_boolean() ? std::optional(found->get<bool>())
                                                    : std::nullopt;
}

std::optional<long> number_of(const json& note, const char* key) {
  const auto found = note.find(key);
  return found != note.end() && found->is_number_integer() ? std::optional(found->get<long>())
                                                           : std::nullopt;
}

template <typename Value>
void put(json& note, const char* key, const std::optional<Value>& value) {
  if (value) note[key] = *value;
}

}  // namespace

LatencyNote::LatencyNote(const fs::path& folder, const std::string& port)
    : file_(folder.empty() ? folder : folder / (port + ".json")) {}

LatencyBefore LatencyNote::read() const {
  std::ifstream stream(file_);
  const json note = json::parse(stream, nullptr, false);
  if (!note.is_object() || note.value("start", json()) != start_of_the_system()) return {};
  return {flag_of(note, "low_latency"), number_of(note, "rx_trig_bytes"),
          number_of(note, "latency_timer")};
}

void LatencyNote::keep(const LatencyBefore& before) const {
  if (file_.empty()) return;
  json note{{"start", start_of_the_system()}};
  put(note, "low_latency", before.low_latency);
  put(note, "rx_trig_bytes", before.trigger);
  put(note, "latency_timer", before.timer);
  std::error_code failed;  // a state folder that cannot be written is as none
  fs::create_directories(file_.parent_path(), failed);
  const fs::path fresh = file_.string() + '.' + std::to_string(::getpid());
  std::ofstream(fresh) << note.dump() << '\n';
  fs::rename(fresh, file_, failed);
}

void LatencyNote::drop() const {
  std::error_code failed;
  if (!file_.empty()) fs::remove(file_, failed);
}

}  // namespace fieldproof::endpoints
