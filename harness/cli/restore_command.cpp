// Puts back what an interrupted run left behind: all that is open in its journal, the latest first.
#include <fmt/format.h>
#include <filesystem>

#include "harness/bench/what_to_check.hpp"
#include "harness/cli/commands.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/exchange/exchange.hpp"
#include "harness/run/run_report.hpp"
#include "harness/safety/journal_note.hpp"
#include "harness/safety/saved_memory.hpp"
#include "harness/system/interrupt.hpp"

namespace fieldproof::cli {

namespace {

constexpr Duration start_patience = 10s, response_max = 500ms;

/// A device of the journal, opened.
struct Connection {
  safety::JournalDevice device;
  std::unique_ptr<endpoints::Endpoint> endpoint;
  std::unique_ptr<harness::Protocol> configured;
  std::unique_ptr<safety::SavedMemory> memory;
};

/// Opens the device and waits until it answers. Errors say what to check.
Result<Connection> connect(const safety::JournalDevice& device, const std::string& endpoint_text,
                           const harness::Protocols& protocols) {
  Connection connection{device, {}, {}, {}};
  Result<endpoints::EndpointName> name = endpoints::parse_endpoint(endpoint_text);
  if (!name) return name.error();
  name->options["protocol"] = device.protocol;
  const Result<const harness::Protocol*> protocol = protocols.choose(device.protocol, device.model);
  if (!protocol) return protocol.error();
  const harness::Protocol& spoken = endpoints::spoken_over(*name, **protocol);
  Result<std::unique_ptr<harness::Protocol>> configured =
      spoken.configured(device.model, device.config);
  if (!configured) return configured.error();
  connection.configured = std::move(*configured);
  const harness::Protocol& declared = connection.configured ? *connection.configured : spoken;
  Result<std::unique_ptr<endpoints::Endpoint>> endpoint = endpoints::open_endpoint(*name, declared);
  if (!endpoint) return endpoint.error();
  connection.endpoint = std::move(*endpoint);
  if (Status begun =
          connection.endpoint->begin({{"station", device.station}, {"model", device.model}});
      !begun)
    return begun.error();
  exchange::Exchange exchange(*connection.endpoint, declared, {});
  const Result<exchange::Sign> alive = exchange.first_sign(device.station, start_patience);
  if (!alive) return alive.error();
  if (*alive != exchange::Sign::alive)
    return fail(bench::why_silent({connection.endpoint.get(), &declared, device.station}, *alive));
  connection.memory = std::make_unique<safety::SavedMemory>(*connection.endpoint, declared,
                                                            response_max, device, nullptr);
  return connection;
}

/// An adapter that was pulled out comes back as the next free number.
std::string under_another_name(const std::string& endpoint) {
  const std::size_t options = std::min(endpoint.find('?'), endpoint.size());
  return "; where it came back under another name, add --endpoint " +
         run::shell_word("serial:/dev/NAME" + endpoint.substr(options));
}

class Restoration {
 public:
  Restoration(safety::Journal& journal, std::string endpoint, const harness::Protocols& protocols)
      : journal_(journal), endpoint_(std::move(endpoint)), protocols_(protocols) {}

  /// All that is open, the latest first; false where something could not be put back.
  bool run() {
    const std::vector<safety::OpenEntry> entries = journal_.open_entries();
    for (auto one = entries.rbegin(); one != entries.rend(); ++one) {
      const Status done = put_back(*one);
      if (done)
        run::tell(fmt::format("restored      {} = {} on {}\n", one->address, one->value,
                              endpoint_of(one->device)));
      else
        run::tell(fmt::format("NOT RESTORED  {} = {} on {}: {}\n", one->address, one->value,
                              endpoint_of(one->device), done.error().message));
      all_ = all_ && done;
    }
    return all_;
  }

 private:
  const std::string& endpoint_of(const safety::JournalDevice& device) const {
    return endpoint_.empty() ? device.endpoint : endpoint_;
  }

  Status put_back(const safety::OpenEntry& entry) {
    if (!connection_ || connection_->device != entry.device) {
      if (failed_ && failed_->first == entry.device) return failed_->second;
      connection_.reset();  // before the same port is opened again
      Result<Connection> opened = connect(entry.device, endpoint_of(entry.device), protocols_);
      if (!opened) {
        Error why = opened.error();
        if (why.absent && endpoint_.empty())
          why.message += under_another_name(entry.device.endpoint);
        failed_ = {entry.device, why};
        return why;
      }
      connection_ = std::move(*opened);
    }
    if (Status done = connection_->memory->put_back(entry); !done) return done;
    return journal_.restored(entry);
  }

  safety::Journal& journal_;
  std::string endpoint_;
  harness::Protocols protocols_;
  std::optional<Connection> connection_;
  std::optional<std::pair<safety::JournalDevice, Error>> failed_;
  bool all_ = true;
};

}  // namespace

int restore_command(const RestoreOptions& options, const harness::Protocols& protocols) {
  if (!std::filesystem::exists(options.journal))
    return run::complain(
        fmt::format("cannot read journal {}: there is no such file; a run keeps it in "
                    "its folder of reports, as journal.ndjson",
                    options.journal),
        run::exit_code::usage);
  Result<safety::Journal> journal = safety::Journal::open(options.journal);
  if (!journal) return run::complain(journal.error().message, run::exit_code::usage);
  if (journal->open_entries().empty()) {
    safety::JournalNote::drop_all(journal->path());
    run::tell(fmt::format("nothing to put back: {} has no open entry\n", options.journal));
    return run::exit_code::ok;
  }
  os::catch_interrupts();
  if (Restoration(*journal, options.endpoint, protocols).run()) {
    safety::JournalNote::drop_all(journal->path());
    return run::exit_code::ok;
  }
  if (os::interrupted()) return run::exit_code::interrupted;
  return run::complain(
      fmt::format(
          "not all is as it was; correct what is said above and type again: fieldproof restore {}",
          run::shell_word(options.journal)),
      run::exit_code::trouble);
}

}  // namespace fieldproof::cli
