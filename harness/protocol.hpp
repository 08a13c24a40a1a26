// All that the harness needs to know of a protocol. One implementation a protocol, in suites/.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/notation/dressing.hpp"
#include "harness/notation/frame_template.hpp"
#include "harness/protocol_parts.hpp"
#include "src/base/burst.hpp"
#include "src/base/bytes.hpp"
#include "src/base/result.hpp"
#include "src/base/time.hpp"
#include "src/plc/emulated_device.hpp"
#include "src/plc/frame_monitor.hpp"

namespace fieldproof::harness {

/// One named part of a frame, as `frame` and the field-by-field difference show it.
struct Field {
  std::string name;        // "block count"
  std::size_t offset = 0;  // first byte in the frame
  std::size_t size = 0;    // bytes
  std::string text;        // printable form: "02", "%MW020"
  std::string
      problem;  // empty when the field is right: "not hex", "expected D6 (sum of header to tail)"
};
/// Are there fields, all of them right?
bool faultless(const std::vector<Field>& fields);

class Protocol {
 public:
  virtual ~Protocol() = default;

  /// "xgt-cnet", as in the endpoint option `protocol`; vectors of folder "xgt_cnet" belong to it.
  virtual std::string_view name() const = 0;

  /// Models that `make_device` knows, the default first: "xbc-h", "xbm-s", "xec-h".
  virtual std::vector<std::string> models() const = 0;
  virtual bool has_model(std::string_view model) const;
  /// What is known of the frames and the probe of one model, where models differ in it.
  virtual const Protocol& of_model([[maybe_unused]] std::string_view model) const { return *this; }

  /// A new emulated device in its power-on state. Errors name the model or the key of `config`
  /// (vectors/README.md).
  virtual Result<std::unique_ptr<plc::EmulatedDevice>> make_device(
      std::string_view model, const nlohmann::json& config) const = 0;

  /// Does a manual print its frames? Else it is tested on a model alone: there is nothing to serve,
  /// and no way to ask a device.
  virtual bool has_frames() const { return true; }
  /// How a device of it is reached nevertheless: by what it serves on a network, or else on a line.
  /// nullptr: there is no way.
  virtual const Protocol* carried([[maybe_unused]] bool network) const { return nullptr; }

  /// The port of its servers; 0: it runs on a serial line.
  virtual std::uint16_t default_port() const { return 0; }
  bool on_network() const { return default_port() != 0; }
  /// Where they take datagrams.
  virtual std::uint16_t datagram_port() const { return default_port(); }
  std::uint16_t port_for(Transport transport) const {
    return transport == Transport::tcp ? default_port() : datagram_port();
  }

  /// The station number as it stands in a frame.
  virtual Bytes station_bytes(int station) const = 0;

  /// Numbers travel as hex digits, two a byte; else as bytes.
  virtual bool is_text() const { return true; }

  /// The checks that its frames have, for the notation. They live as long as the program.
  virtual notation::Checks checks() const { return {}; }
  /// What stands before a name in its frames, for the notation; nullptr: they have none.
  virtual notation::NameHead name_head() const { return nullptr; }
  /// What the moving fields of the notation become at a station.
  notation::Fields fields_at(int station) const;

  /// How it frames a body that it shares with other protocols: pdu(...) of a vector. nullptr: it
  /// shares none.
  virtual const notation::Dressing* dressing() const { return nullptr; }

  /// No frame of it has more bytes: what goes on for longer does not end.
  virtual std::size_t longest_frame() const { return 1024; }

  /// Do its frames have an end, by which one can be told from the next?
  virtual bool has_frame_ends() const { return true; }
  /// The length of the first complete frame in `bytes`, or nothing while it is incomplete.
  virtual std::optional<std::size_t> frame_length(ByteView bytes) const = 0;

  /// Does it begin as frames of this protocol alone do, whatever follows?
  virtual bool has_mark([[maybe_unused]] ByteView frame) const { return false; }
  /// The parts of a frame, as far as it can be read; never fails.
  virtual std::vector<Field> explain(ByteView frame) const = 0;
  /// The same where the bench knows who sends it: a reply that happens to have the form of a
  /// request is none.
  virtual std::vector<Field> explain_as(ByteView frame, [[maybe_unused]] bool request) const {
    return explain(frame);
  }
  /// Has a good reply to `request` the same bytes (Modbus 05, 06)? Else they are an echo.
  virtual bool reply_repeats([[maybe_unused]] ByteView request) const { return false; }
  /// A client's request in the letters of the vectors, its check recomputed, where the manuals
  /// leave it to the client how letters are written (Cnet EN 7.1.3). As it is where nothing is
  /// free.
  virtual Bytes in_plain_letters(ByteView request) const {
    return {request.begin(), request.end()};
  }

  /// What a frame monitor says of a frame that a client (else a server) sends or receives:
  /// `unknown` where it is damaged, or none that this side deals with.
  virtual plc::FrameResult monitor_result(ByteView frame, bool client, bool sent) const;

  /// The silence that must lie between anything on the line and the next request. Modbus RTU ends a
  /// frame by it. Zero where a frame has an end of its own.
  virtual Duration frame_gap([[maybe_unused]] Duration character_time) const { return {}; }

  /// Parts that not every protocol has; nullptr: it has none. They live as long as it does.
  virtual const Probing* probing() const { return nullptr; }
  virtual const MemoryRequests* memory() const { return nullptr; }
  virtual const Tables* tables() const { return nullptr; }
  virtual const Texts* texts() const { return nullptr; }

  /// As those parts have it. Without probing: no probe. Without memory or tables: an error.
  Bytes probe(int station, ByteView tested) const;
  bool is_reply_to_probe(ByteView probe, ByteView reply) const;
  Result<std::vector<Bytes>> write_requests(int station, std::string_view address,
                                            std::string_view hex) const;
  Result<std::vector<Bytes>> read_requests(int station, std::string_view address,
                                           std::size_t digits) const;
  Status write_reply(ByteView reply) const;
  Result<std::string> read_reply(ByteView reply) const;
  /// Is `reply` the undamaged answer to that request for memory, a refusal included? The error says
  /// what is wrong with it.
  Status sound_reply(ByteView request, ByteView reply) const;
  Status check_fact(const nlohmann::json& facts) const;

  /// This protocol as a device of `model` that declares `config` (keys of given.config) speaks it:
  /// what follows, and the memory requests, then know where its addresses lie. nullptr: they lie
  /// there on any. Errors name the key.
  virtual Result<std::unique_ptr<Protocol>> configured(std::string_view model,
                                                       const nlohmann::json& config) const;

  /// What a device of `model` has that is told nothing: keys of given.config of this protocol.
  virtual nlohmann::json defaults(std::string_view model) const;
  /// Do two texts for a key of given.config mean the same to a device of `model`? M0 and M0000 do
  /// where they name a place.
  virtual bool same_setting([[maybe_unused]] std::string_view model,
                            [[maybe_unused]] const std::string& key, const std::string& one,
                            const std::string& other) const {
    return one == other;
  }

  /// What a vector calls an address, and the digits there, on the declared device, for a case that
  /// sends these requests. Errors say why the case cannot be moved to where they lie.
  struct Placed {
    std::string address, hex;
  };
  virtual Result<Placed> placed(std::string_view address, std::string_view hex,
                                const std::vector<Bytes>& requests) const;
  /// Why such requests mean something else on the declared device than on one that declares
  /// nothing; empty: they do not.
  virtual std::string tied_to_default(const std::vector<Bytes>& requests) const;

  /// What is set on the declared device, in this order, so that an action of a case (`do`) happens;
  /// empty: it is no matter of memory. Errors say what the device lacks for it.
  using Setting = std::pair<std::string, std::string>;  // address and hex digits
  virtual Result<std::vector<Setting>> set_off_by([[maybe_unused]] std::string_view action) const {
    return std::vector<Setting>{};
  }
  /// What such an action writes by itself, in the device or in a partner of it ("B:D0"): addresses,
  /// and as many digits.
  virtual std::vector<Setting> written_by_action([[maybe_unused]] std::string_view action) const {
    return {};
  }
  /// What must be so on the device before such a case begins: addresses and values. `axis` is one
  /// that it moves.
  virtual std::vector<Setting> premises([[maybe_unused]] std::string_view axis) const { return {}; }
  /// The axis that an action moves ("1", of a partner "B:1"), or that writing to an address moves;
  /// empty: none; "?": one that nobody can tell.
  virtual std::string moves([[maybe_unused]] std::string_view action) const { return {}; }
  virtual std::string moved_by([[maybe_unused]] std::string_view address) const { return {}; }
  /// The last axis that any device of it has; 0: it moves none.
  virtual unsigned last_axis() const { return 0; }

  /// What a case looks at: addresses and digits, or no digits where a range is due.
  using Look = std::vector<Setting>;
  /// Looks in the order of time, while nothing is done to the device: which of them want a moment
  /// to the millisecond? No request keeps one.
  virtual std::vector<bool> of_a_moment(const std::vector<Look>& looks) const {
    return std::vector<bool>(looks.size());
  }

  /// Memory that a request or an address names: words of an area, or its contacts (bits of T and
  /// C), which are apart.
  struct Written {
    std::string area;              // "M"
    std::uint32_t first_word = 0;  // in words of the area
    std::uint32_t last_word = 0;
    std::string address;  // as it stands in the request, for messages
    bool contacts = false;

    bool overlaps(const Written& other) const {
      return area == other.area && contacts == other.contacts && first_word <= other.last_word &&
             other.first_word <= last_word;
    }
    /// Nobody can tell which words of the area; of area "?", not even that.
    bool unknown() const { return last_word == ~0u || area == "?"; }
  };
  /// What a request would write, for the write fence; empty for reads. Read leniently: a damaged
  /// write request names area "?" where its addresses cannot be told.
  virtual std::vector<Written> written_by(ByteView request) const = 0;
  /// A word of an area, or without a number the whole area.
  struct WordName {
    std::string area;
    std::optional<std::uint32_t> word;
  };
  /// What --allow-write names: "M", "M100", "h1230". Nothing: no memory of this protocol.
  virtual std::optional<WordName> read_word(std::string_view text) const;
  /// The other way round: "M100", "h1230".
  virtual std::string spell(std::string_view area, std::uint32_t word) const;

  /// Memory as `read_requests` and `write_requests` reach it: what is saved before a write, and put
  /// back.
  struct Place {
    std::string address;  // "%MW100"
    std::size_t digits = 0;
    bool declared =
        true;  // false: the declared device has no such memory, a write there must be refused
  };
  /// None for what no request can write: there is nothing to put back.
  virtual std::vector<Place> places(const Written& written) const;

  /// What so many digits at an address of a vector name; nothing where the declared device has no
  /// such memory.
  virtual std::optional<Written> named(std::string_view address, std::size_t digits) const;
  /// The same address so many words further on, of the same type and as many characters; nothing
  /// where there is none.
  virtual std::optional<std::string> moved(std::string_view address, int words) const;
  /// An address in a frame. `size` 0: the frame names memory that cannot be moved.
  struct AddressField {
    std::size_t offset = 0, size = 0;
    Written names;
  };
  /// In the order of the frame. `reply`: the frame comes from the device.
  virtual std::vector<AddressField> address_fields(ByteView frame, bool reply) const;
  /// The bytes of that field so many words further on; nothing where there are none of its size.
  virtual std::optional<Bytes> moved_field(ByteView frame, const AddressField& field,
                                           int words) const;
  /// Words of an area of the declared device; 0: it has none.
  virtual std::uint32_t words_of(std::string_view area) const;

  /// Is it only decided how that is spelt? Another maker may read the name otherwise.
  virtual bool is_spelt_by_decision(std::string_view /*address*/) const { return false; }

  /// Areas whose words may be physical outputs: written only when named.
  virtual std::vector<std::string_view> output_areas() const = 0;

  /// Areas of words ("%MW0" is the first of M) by which devices are told apart, with the last words
  /// that the known models have, in rising order. Empty: there are none.
  struct Area {
    std::string name;
    std::vector<std::uint32_t> last_words;
  };
  virtual std::vector<Area> areas() const { return {}; }
};

}  // namespace fieldproof::harness
