#include "suites/xgt_fenet/protocol.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "harness/plc_protocol.hpp"
#include "src/email/email_plc.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/plc/model.hpp"
#include "src/xgt_fenet/plc.hpp"
#include "suites/checks/checks.hpp"
#include "suites/services/clients.hpp"
#include "suites/services/services.hpp"
#include "suites/xgt_cnet/protocol.hpp"
#include "suites/xgt_fenet/frame_parts.hpp"
#include "suites/xgt_fenet/memory_requests.hpp"
#include "suites/xgt_fenet/remote_facts.hpp"

namespace fieldproof::xgt_fenet_suite {

using plc::PlcModel;

namespace {

/// The header of each speaker (FEnet EN 5.2.3). What the server fills in is for vectors of their
/// own, which write it out; and so is what a client puts where the server does not look.
constexpr notation::Dressing dressing_of_frames{
    .frame = "['LSIS-XGT' 00 00 00 00 A0 33 ${transaction} LEN 00 SUM${wrong} ${body}]",
    .reply_of_device = "['LSIS-XGT' 00 00 ?? ?? ?? 11 ${transaction} LEN ?? ?? ${body}]",
    .request_of_device = "['LSIS-XGT' 00 00 ?? ?? ?? 33 ${transaction} LEN ?? ?? ${body}]",
    .reply_of_bench = "['LSIS-XGT' 00 00 07 01 B0 11 ${transaction} LEN 01 SUM${wrong} ${body}]",
    .low_byte_first = true,
    .before_own_word = 4};  // command, data type

class XgtFenet : public harness::PlcProtocol,
                 public harness::Probing,
                 public harness::MemoryRequests,
                 public harness::Tables {
 public:
  using PlcProtocol::PlcProtocol;

  std::string_view name() const override { return "xgt-fenet"; }

  std::uint16_t default_port() const override { return xgt_fenet::tcp_port; }
  std::uint16_t datagram_port() const override { return xgt_fenet::udp_port; }

  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(
      std::string_view model, const nlohmann::json& config) const override {
    return services::make_plc(model, config, [](plc::Plc& plc, const nlohmann::json& own) {
      return p2p::is_p2p_client(own) ? add_clients(plc, own) : xgt_fenet::add_server(plc, own);
    });
  }

  /// Frames name no station: the address of the module is that of the network.
  Bytes station_bytes(int) const override { return {}; }
  bool is_text() const override { return false; }
  notation::Checks checks() const override {
    static const std::array all{checks::fenet_length, checks::fenet_sum};
    return all;
  }
  notation::NameHead name_head() const override {
    return [](std::size_t characters) {
      Bytes head;
      put_word(head, characters);
      return head;
    };
  }
  const notation::Dressing* dressing() const override { return &dressing_of_frames; }
  /// A continuous write of 512 bytes with a name of 16 characters (FEnet EN 5.1.2, 5.2.5).
  std::size_t longest_frame() const override { return 600; }
  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    return xgt_fenet_suite::frame_length(bytes);
  }
  /// Eight letters of a company.
  bool has_mark(ByteView frame) const override {
    const auto begins = [&](const xgt_fenet::CompanyId& id) {
      return std::ranges::equal(frame.first(std::min<std::size_t>(frame.size(), 8)),
                                ByteView(id).first(8));
    };
    return begins(xgt_fenet::lsis_xgt) || begins(xgt_fenet::lgis_glofa);
  }
  std::vector<harness::Field> explain(ByteView frame) const override {
    return xgt_fenet_suite::explain(frame);
  }

  const harness::Probing* probing() const override { return this; }
  const harness::MemoryRequests* memory() const override { return this; }
  const harness::Tables* tables() const override { return this; }

  Bytes probing_request(int, ByteView tested) const override {
    return xgt_fenet_suite::probing_request(tested);
  }
  std::vector<harness::ReadLimit> read_limits() const override {
    return {{"bytes of a continuous read", 512, 2000, read_of_bytes},
            {"blocks of a read", 16, 64, read_of_blocks}};
  }
  bool answers_probe(ByteView probe, ByteView reply) const override {
    return reply.size() > header_size && word_at(reply, invoke_at) == word_at(probe, invoke_at);
  }

  Result<std::vector<Bytes>> requests_to_write(int, std::string_view address,
                                               std::string_view hex) const override {
    return xgt_fenet_suite::write_requests(address, hex);
  }
  Result<std::vector<Bytes>> requests_to_read(int, std::string_view address,
                                              std::size_t digits) const override {
    return xgt_fenet_suite::read_requests(address, digits);
  }
  Status acknowledged(ByteView reply) const override { return xgt_fenet_suite::write_reply(reply); }
  Result<std::string> digits_in(ByteView reply) const override {
    return xgt_fenet_suite::read_reply(reply);
  }
  bool answers(ByteView request, ByteView reply) const override {
    return xgt_fenet_suite::answers(request, reply);
  }
  /// The sum is of the header alone, and no server need look at it.
  bool is_checked(ByteView) const override { return false; }
  std::vector<Written> written_by(ByteView request) const override {
    return xgt_fenet_suite::written_by(request, declared_model());
  }

  Result<std::unique_ptr<harness::Protocol>> configured(std::string_view model,
                                                        const nlohmann::json&) const override {
    return std::unique_ptr<harness::Protocol>(
        std::make_unique<XgtFenet>(plc::find_plc_model(model)));
  }
  std::vector<AddressField> address_fields(ByteView frame, bool reply) const override {
    return reply ? std::vector<AddressField>() : xgt_fenet_suite::address_fields(frame, model());
  }
  /// Bits: cnet/bit-names, fenet/memory-map.
  bool is_spelt_by_decision(std::string_view address) const override {
    return harness::is_bit_name(address);
  }
  std::vector<std::string_view> output_areas() const override { return {"P", "Q", "U"}; }

  /// Areas, and flags and registers of P2P, are those of the same PLC on Cnet.
  Status check_table(const nlohmann::json& facts) const override {
    return is_remote_fact(facts) ? check_remote_fact(facts)
                                 : xgt_cnet_suite::protocol().check_fact(facts);
  }

 private:
  static Status add_clients(plc::Plc& plc, const nlohmann::json& config) {
    const Status added =
        p2p::add_network_clients(plc, config, services::client_drivers("xgt-fenet"));
    return added ? email::add_email(plc, config) : added;
  }
};

}  // namespace

const harness::Protocol& protocol() {
  static const XgtFenet xgt_fenet;
  return xgt_fenet;
}

}  // namespace fieldproof::xgt_fenet_suite
