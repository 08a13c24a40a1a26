// Requests of the XGT client (Cnet EN and KO 6.3, 7.1).
#include <fmt/format.h>

#include <map>

#include "src/base/letters.hpp"
#include "suites/p2p/broken/faults.hpp"

namespace fieldproof::p2p_broken {

using p2p::P2pBlock;
using xgt_cnet::XgtRequest;

namespace {

bool writes(const P2pBlock& block) { return block.function == P2pBlock::Function::write; }

/// Sends another request than the good one; the texts of the edit live until it is sent.
MakeBehaviour sends(
    std::function<void(XgtRequest& request, std::vector<std::string>& texts)> edit) {
  return spoils([=](Bytes& bytes) {
    const Bytes good = bytes;
    XgtRequest request = xgt_cnet::parse_request(good);
    std::vector<std::string> texts;
    texts.reserve(2 * xgt_cnet::xgt_max_blocks);
    edit(request, texts);
    bytes.clear();
    xgt_cnet::encode_request(request, bytes);
  });
}

MakeBehaviour names(std::function<std::string(std::string_view name)> edit) {
  return sends([=](XgtRequest& request, std::vector<std::string>& texts) {
    for (unsigned i = 0; i < request.blocks; ++i)
      request.block.at(i).name = texts.emplace_back(edit(request.block.at(i).name));
  });
}

/// The digits of each element that is written.
MakeBehaviour digits(std::size_t most, std::function<std::string(std::string digits)> edit) {
  return sends([=](XgtRequest& request, std::vector<std::string>& texts) {
    for (unsigned i = 0; i < request.blocks; ++i) {
      const std::size_t size =
          std::min(most, std::size_t{2} * plc::type_bytes(request.block.at(i).name[2]));
      const std::string right(request.block.at(i).data);
      std::string& wrong = texts.emplace_back();
      for (std::size_t at = 0; at < right.size(); at += size) wrong += edit(right.substr(at, size));
      request.block.at(i).data = wrong;
    }
  });
}

std::string bytes_reversed(std::string digits) {
  std::string wrong;
  for (std::size_t at = digits.size(); at >= 2; at -= 2) wrong += digits.substr(at - 2, 2);
  return wrong;
}

std::string words_reversed(std::string digits) {
  std::string wrong;
  for (std::size_t at = digits.size(); at >= 4; at -= 4) wrong += digits.substr(at - 4, 4);
  return wrong.empty() ? digits : wrong;
}

std::string next_name(std::string_view name) {
  return fmt::format("{}{}", name.substr(0, 3), std::stoi(std::string(name.substr(3))) + 1);
}

std::string padded_name(std::string_view name) {
  return fmt::format("{}{:0>5}", name.substr(0, 3), name.substr(3));
}

void upper_case(XgtRequest& request, std::vector<std::string>&) {
  request.command = upper(request.command);
}

void set_bcc(Bytes& frame, int offset = 0) {
  const int right = xgt_cnet::xgt_bcc(ByteView(frame).first(frame.size() - 2));
  std::ranges::copy(hex_number(static_cast<Byte>(right + offset), 2), frame.end() - 2);
}

MakeBehaviour bcc_higher_by(int offset) {
  return spoils([=](Bytes& request) { set_bcc(request, offset); });
}

MakeBehaviour spoils_with_bcc(std::function<void(Bytes& request)> edit) {
  return spoils([=](Bytes& request) {
    edit(request);
    set_bcc(request);
  });
}

/// Writes what memory held at the first request.
Behaviour remembers() {
  const auto first = std::make_shared<std::map<unsigned, Bytes>>();
  return {.asks = [=](p2p::P2pDriver& good, const P2pBlock& block,
                      const plc::PlcMemory& memory) -> Result<Bytes> {
    const Result<Bytes> request = good.request(block, memory);
    return request ? Result<Bytes>(first->try_emplace(block.number, *request).first->second)
                   : request;
  }};
}

/// All blocks ask the station of the block that was asked first.
Behaviour one_station() {
  const auto station = std::make_shared<std::optional<unsigned>>();
  return {.asks = [=](p2p::P2pDriver& good, P2pBlock block, const plc::PlcMemory& memory) {
    if (!*station) *station = block.station;
    block.station = **station;
    return good.request(block, memory);
  }};
}

}  // namespace

std::vector<Fault> xgt_request_faults() {
  return {
      {"bcc_missing", "the request has no BCC",
       spoils([](Bytes& request) { request.resize(request.size() - 2); }),
       "xgt_cnet/client/read_cycle", "BCC: expected A4, got nothing"},
      {"bcc_off_by_one", "the BCC is one too high", bcc_higher_by(1), "xgt_cnet/client/read_cycle",
       "BCC: expected A4, got A5"},
      {"bcc_without_header", "ENQ is not in the sum of the BCC", bcc_higher_by(-xgt_cnet::xgt_enq),
       "xgt_cnet/client/monitor_capture", "BCC: expected 40, got 3B"},
      {"etx_for_eot", "a request ends with ETX",
       spoils_with_bcc([](Bytes& request) { request.at(request.size() - 3) = xgt_cnet::xgt_etx; }),
       "xgt_cnet/client/read_cycle", "surplus: expected nothing, got <03>A3"},
      {"upper_case_command", "commands go out in upper case, without BCC", sends(upper_case),
       "xgt_cnet/client/read_cycle", "command: expected r, got R"},
      {"names_padded", "names go out with leading zeros", names(padded_name),
       "xgt_cnet/client/read_cycle", "name length: expected 06, got 08"},
      {"address_one_too_high", "the address of the partner is one too high", names(next_name),
       "xgt_cnet/client/read/single/word", "name: expected %MW15, got %MW16"},
      {"name_length_off_by_one", "the length of a name is one too low",
       spoils_with_bcc([](Bytes& request) { --request.at(request.size() > 9 ? 9 : 0); }),
       "xgt_cnet/client/read_cycle", "name length: expected 06, got 05"},
      {"block_count_off_by_one", "the number of blocks is one too high",
       spoils_with_bcc([](Bytes& request) { ++request.at(7); }), "xgt_cnet/client/read_cycle",
       "block count: expected 01, got 02"},
      {"run_in_bytes", "the number of a run is that of its bytes",
       sends([](XgtRequest& request, auto&) {
         request.count *= plc::type_bytes(request.block[0].name[2]);
       }),
       "xgt_cnet/client/run/read/words", "number of data: expected 02, got 04"},
      {"run_one_too_long", "the number of a run is one too high",
       sends([](XgtRequest& request, auto&) { request.count += 1; }),
       "xgt_cnet/client/run/read/bytes", "number of data: expected 03, got 04"},
      {"station_of_first_block", "every block asks the station of the first", one_station,
       "xgt_cnet/client/schedule/block_order", "station: expected 05, got 03"},
      {"station_decimal", "the station goes out as a decimal number",
       spoils_with_bcc([](Bytes& request) {
         const XgtRequest right = xgt_cnet::parse_request(request);
         std::ranges::copy(fmt::format("{:02}", right.station % 100), request.begin() + 1);
       }),
       "xgt_cnet/client/write/station/s31", "station: expected 1F, got 31"},
      {"first_variable_only", "of several variables only the first is asked for",
       asks_for([](P2pBlock& block) { block.variables.resize(1); }),
       "xgt_cnet/client/write/two_dwords", "block count: expected 02, got 01"},
      {"variables_in_reverse", "the last variable comes first",
       asks_for([](P2pBlock& block) { std::ranges::reverse(block.variables); }),
       "xgt_cnet/client/write/two_dwords", "name length 1: expected 05, got 04"},
      {"read_for_write", "a write goes out as a read of the same variables",
       asks_for([](P2pBlock& block) { block.function = P2pBlock::Function::read; }),
       "xgt_cnet/client/write/single/word", "command: expected w, got r"},
      {"run_as_single", "a run goes out as one single variable",
       asks_for([](P2pBlock& block) { block.continuous = false; }),
       "xgt_cnet/client/run/write/words", "command type: expected SB, got SS"},
      {"single_as_run", "a single variable goes out as a run of one", asks_for([](P2pBlock& block) {
         block.continuous = block.variables.size() == 1 && block.type != 'X';
         block.size = 1;
       }),
       "xgt_cnet/client/write/single/word", "command type: expected SS, got SB"},
      {"own_area_off_by_one", "a write takes its data one element too high",
       asks_for([](P2pBlock& block) {
         for (p2p::P2pVariable& variable : block.variables)
           if (writes(block)) variable.own = variable.own + 1;
       }),
       "xgt_cnet/client/write/single/word", "data: expected 2468, got 9BDF"},
      {"write_bytes_swapped", "what is written goes out low byte first", digits(16, bytes_reversed),
       "xgt_cnet/client/write/single/word", "data: expected 2468, got 6824"},
      {"write_halves_swapped", "what is written goes out low word first",
       digits(16, words_reversed), "xgt_cnet/client/write/two_dwords",
       "data 1: expected 75318642, got 86427531"},
      {"writes_first_value", "every write sends what memory held at the first", remembers,
       "xgt_cnet/client/write/value_of_the_moment", "data: expected 5ABC, got 2468"},
  };
}

}  // namespace fieldproof::p2p_broken
