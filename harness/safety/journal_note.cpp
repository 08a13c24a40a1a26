#include "harness/safety/journal_note.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>

#include "harness/endpoints/kinds.hpp"
#include "harness/system/state_folder.hpp"
#include "reports/results/sha256.hpp"

namespace fieldproof::safety {

namespace {

namespace fs = std::filesystem;

fs::path notes_folder() { return os::state_folder("journals"); }

/// A home may be shared by computers that have a port of the same name each.
std::string computer_of(const std::string& endpoint) {
  const Result<endpoints::EndpointName> name = endpoints::parse_endpoint(endpoint);
  if (!name || !endpoints::kind_of(*name).local_port) return {};
  std::array<char, 256> host{};
  return ::gethostname(host.data(), host.size() - 1) == 0 ? host.data() : "";
}

std::string absolute(const std::string& path) {
  return fs::absolute(path).lexically_normal().string();
}

}  // namespace

JournalNote::JournalNote(const JournalDevice& device) : link_(notes_folder()) {
  if (!link_.empty())
    link_ /= results::sha256_of(fmt::format("{}\n{}\n{}", computer_of(device.endpoint),
                                            port_of(device.endpoint), device.station));
}

std::string JournalNote::journal() const {
  std::error_code none;
  return link_.empty() ? "" : fs::read_symlink(link_, none).string();
}

void JournalNote::keep(const std::string& journal) const {
  if (link_.empty()) return;
  std::error_code failed;  // a state folder that cannot be written is as none
  fs::create_directories(link_.parent_path(), failed);
  const fs::path fresh = fmt::format("{}.{}", link_.string(), ::getpid());
  fs::remove(fresh, failed);
  fs::create_symlink(absolute(journal), fresh, failed);
  fs::rename(fresh, link_, failed);
}

void JournalNote::drop(const std::string& journal) const {
  std::error_code failed;
  if (!link_.empty() && this->journal() == absolute(journal)) fs::remove(link_, failed);
}

void JournalNote::drop_all(const std::string& journal) {
  std::error_code failed;
  for (const fs::directory_entry& one : fs::directory_iterator(notes_folder(), failed))
    if (std::error_code none; fs::read_symlink(one.path(), none) == absolute(journal))
      fs::remove(one.path(), none);
}

}  // namespace fieldproof::safety
