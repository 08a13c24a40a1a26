#include "suites/modbus/tcp_broken/broken_server.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "src/modbus/bases.hpp"
#include "src/modbus/data_space.hpp"
#include "src/modbus/modbus_plc.hpp"

namespace fieldproof::modbus_tcp_broken {

namespace {

constexpr unsigned least_length = 2, most_length = 260;

/// Puts streams together for the good server, which hears whole frames alone, each answered at
/// once: so each reply is known to belong to its request.
class BrokenServer : public plc::EmulatedDevice, public net::Host {
 public:
  BrokenServer(Behaviour behaviour, std::unique_ptr<plc::Plc> good)
      : behaviour_(std::move(behaviour)), good_(std::move(good)), server_{*good_} {}

  net::Host* network() override { return this; }
  Status set(std::string_view address, std::string_view hex) override {
    return good_->set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return good_->get(address, digits);
  }
  Status act(std::string_view action) override { return good_->act(action); }

  bool listens(Transport transport, std::uint16_t port) const override {
    return good_->network()->listens(transport, port);
  }
  void receive(const Burst& burst) override {
    now_ = burst.start;
    if (!behaviour_.hear) return take(burst);
    for (const Burst& heard : behaviour_.hear(burst, server_)) take(heard);
  }
  std::optional<Time> wake_at() const override {
    return does_.empty() ? good_->network()->wake_at() : std::optional(now_);
  }
  std::vector<Burst> advance(Time now) override {
    now_ = now;
    collect();
    if (behaviour_.act) behaviour_.act(does_, server_);
    return std::exchange(does_, {});
  }

 private:
  void take(const Burst& heard) {
    if (heard.event == LinkEvent::data) return take_bytes(heard);
    streams_.erase(heard.link);
    if (heard.event == LinkEvent::opened)
      server_.links.push_back(heard.link);
    else
      std::erase(server_.links, heard.link);
    good_->network()->receive(heard);
    collect();
  }

  void take_bytes(const Burst& heard) {
    Bytes& stream = streams_[heard.link];
    stream.insert(stream.end(), heard.bytes.begin(), heard.bytes.end());
    while (const std::optional<Bytes> request = next_request(heard.link)) ask(heard, *request);
  }

  /// Taken from the stream of the link, which may be gone: a request may make the server reset it.
  std::optional<Bytes> next_request(LinkId link) {
    const auto found = streams_.find(link);
    if (found == streams_.end() || found->second.size() < unit_at) return std::nullopt;
    Bytes& stream = found->second;
    const unsigned length = word_at(stream, length_at);
    const bool possible = length >= least_length && length <= most_length;
    if (possible && stream.size() < unit_at + length) return std::nullopt;
    const auto end =
        possible ? stream.begin() + static_cast<std::ptrdiff_t>(unit_at + length) : stream.end();
    const Bytes request(stream.begin(), end);
    stream.erase(stream.begin(), end);
    return request;
  }

  void ask(const Burst& heard, const Bytes& request) {
    Burst understood = heard;
    understood.bytes = behaviour_.misread ? behaviour_.misread(request) : request;
    if (understood.bytes.empty()) return;
    const std::size_t before = does_.size();
    good_->network()->receive(understood);
    collect();
    for (std::size_t i = before; behaviour_.edit && i < does_.size(); ++i)
      if (does_[i].event == LinkEvent::data) behaviour_.edit(does_[i].bytes, request);
  }

  void collect() {
    for (Burst& burst : good_->network()->advance(now_)) {
      if (burst.event == LinkEvent::reset) {
        std::erase(server_.links, burst.link);
        streams_.erase(burst.link);
      }
      does_.push_back(std::move(burst));
    }
  }

  Behaviour behaviour_;
  std::unique_ptr<plc::Plc> good_;
  Server server_;
  std::map<LinkId, Bytes> streams_;
  Bursts does_;
  Time now_{};
};

Result<std::unique_ptr<modbus::DataSpace>> data_of(plc::PlcMemory& memory,
                                                   const nlohmann::json& config) {
  modbus::ModbusBases bases = modbus::default_modbus_bases(memory.model());
  for (std::size_t i = 0; i < bases.size(); ++i)
    bases[i] = config.value(std::string(modbus::modbus_base_names[i]) + "_base", bases[i]);
  const Result<modbus::ModbusTables> tables = modbus::place_modbus_tables(memory.model(), bases);
  if (!tables) return tables.error();
  return std::unique_ptr<modbus::DataSpace>(
      std::make_unique<modbus::PlcDataSpace>(*tables, memory));
}

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_server(Behaviour behaviour,
                                                                std::string_view model,
                                                                const nlohmann::json& config) {
  Result<std::unique_ptr<plc::Plc>> good = plc::make_plc(model, config);
  if (!good) return good.error();
  modbus::TcpServerConfig settings = modbus::fenet_server();
  if (const Status read = modbus::read_tcp_config(config, settings); !read) return read.error();
  if (behaviour.settings) behaviour.settings(settings);
  Result<std::unique_ptr<modbus::DataSpace>> data = data_of((*good)->memory(), config);
  if (!data) return data.error();
  const Status added =
      (*good)->add(std::make_unique<modbus::ModbusTcpServer>(std::move(*data), settings));
  if (!added) return added.error();
  return std::unique_ptr<plc::EmulatedDevice>(
      std::make_unique<BrokenServer>(std::move(behaviour), std::move(*good)));
}

}  // namespace fieldproof::modbus_tcp_broken
