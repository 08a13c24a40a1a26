#include "suites/xgt_fenet/memory_requests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "harness/device_names.hpp"
#include "harness/notation/beginning.hpp"
#include "suites/xgt_fenet/frame_parts.hpp"

namespace fieldproof::xgt_fenet_suite {

using harness::ElementName;
using harness::Field;
using harness::Protocol;

namespace {

constexpr std::size_t blocks_at_once = 16, bytes_at_once = 512;
constexpr std::string_view company_ids[] = {"LSIS-XGT", "LGIS-GLOFA"};

Bytes frame_of(ByteView body, unsigned invoke) {
  Bytes frame = to_bytes(std::string("LSIS-XGT\0\0\0\0\xA0\x33", 14));
  put_word(frame, invoke);
  put_word(frame, body.size());
  frame.push_back(0);
  frame.push_back(static_cast<Byte>(std::accumulate(frame.begin(), frame.end(), 0u)));
  frame.insert(frame.end(), body.begin(), body.end());
  return frame;
}

/// Of what the bench asks for itself: another one for another request.
Bytes own_frame(ByteView body) {
  unsigned sum = 0;
  for (const Byte byte : body) sum = sum * 31 + byte;
  return frame_of(body, 0x4000 | (sum & 0x3FFF));
}

Bytes request_head(unsigned command, unsigned type, std::size_t blocks) {
  Bytes body;
  for (const std::size_t word : {std::size_t{command}, std::size_t{type}, std::size_t{0}, blocks})
    put_word(body, word);
  return body;
}

void put_name(Bytes& body, std::string_view name) {
  put_word(body, name.size());
  const Bytes text = to_bytes(name);
  body.insert(body.end(), text.begin(), text.end());
}

/// Elements of one request: its first name, and for a write what they get.
struct Part {
  std::vector<std::string> names;  // of a run of bytes the first alone
  std::size_t bytes = 0;           // of all
  Bytes data;                      // as written in hex
};

/// The type of the requests for a name; a run of bytes is continuous.
unsigned type_of(const ElementName& name, std::size_t elements) {
  return name.type == 'B' && elements > 1
             ? continuous_type
             : static_cast<unsigned>(std::string_view("XBWDL").find(name.type));
}

struct Plan {
  unsigned type = 0;
  std::size_t element = 0;  // bytes
  std::vector<Part> parts;
};

/// Cuts `digits` of memory from `address` on into requests.
Result<Plan> plan_of(std::string_view address, std::size_t digits, std::string_view hex) {
  if (address.starts_with('@'))
    return fail(fmt::format("{} is a counter, which no command reaches", address));
  const std::optional<ElementName> name = harness::read_element_name(address);
  if (!name) return fail(fmt::format("'{}' is no device name such as %MW100", address));
  const std::size_t element = name->element_bytes();
  if (digits == 0 || digits % (2 * element) != 0)
    return fail(fmt::format("{} digits are not a whole number of elements of {} ({} digits each)",
                            digits, address, 2 * element));
  const std::size_t count = digits / (2 * element);
  if (name->type == 'X' && count > 1)
    return fail(fmt::format("{}: several bits at once; name each bit", address));
  const std::optional<Bytes> data = from_hex(hex);
  if (!data) return fail(fmt::format("'{}' is not hex", hex));
  Plan plan{type_of(*name, count), element, {}};
  const bool run = plan.type == continuous_type;
  // How the fields of several blocks follow one another in a write is not printed.
  const std::size_t at_once = run ? bytes_at_once : data->empty() ? blocks_at_once : 1;
  for (std::size_t done = 0; done < count; done += at_once) {
    Part part;
    const std::size_t elements = std::min(at_once, count - done);
    part.bytes = elements * element;
    for (std::size_t i = done; i < done + (run ? 1 : elements); ++i) {
      if (i == 0) {
        part.names.emplace_back(address);
        continue;
      }
      const Result<std::string> further = harness::element_further_on(*name, i);
      if (!further) return further.error();
      part.names.push_back(*further);
    }
    if (!data->empty()) {
      const auto begin = data->begin() + static_cast<std::ptrdiff_t>(done * element);
      part.data.assign(begin, begin + static_cast<std::ptrdiff_t>(part.bytes));
    }
    plan.parts.push_back(std::move(part));
  }
  return plan;
}

/// Of one block: hex is most significant first, frames are low byte first.
void put_data(Bytes& body, ByteView hex, bool run) {
  put_word(body, hex.size());
  if (run)
    body.insert(body.end(), hex.begin(), hex.end());
  else
    body.insert(body.end(), hex.rbegin(), hex.rend());
}

const Field* find(const std::vector<Field>& fields, std::string_view name) {
  const auto found = std::ranges::find(fields, name, &Field::name);
  return found == fields.end() ? nullptr : &*found;
}

std::optional<std::string> refusal(ByteView reply) {
  if (reply.empty()) return "no answer";
  const std::vector<Field> fields = explain(reply);
  if (const Field* code = find(fields, "error code"))
    return "the device refuses with error " + code->text;
  const Field* command = find(fields, "command");
  if (!command || (reply[header_size] & 1) == 0)
    return "the answer is no reply: " + notation::print_beginning(reply);
  return std::nullopt;
}

/// What stands in the data fields, each block by itself.
std::vector<Bytes> data_of(ByteView frame) {
  std::vector<Bytes> data;
  for (const Field& field : explain(frame))
    if (is_field(field, data_field)) {
      const ByteView bytes = frame.subspan(field.offset, field.size);
      data.emplace_back(bytes.begin(), bytes.end());
    }
  return data;
}

std::size_t total(const std::vector<Bytes>& data) {
  return std::accumulate(data.begin(), data.end(), std::size_t{0},
                         [](std::size_t sum, const Bytes& one) { return sum + one.size(); });
}

/// Bytes that a read request of this room asks for.
std::size_t bytes_asked_for(ByteView request) {
  std::size_t bytes = 0;
  for (const Field& field : explain(request)) {
    if (field.name == count_field && field.size == 2) return word_at(request, field.offset);
    if (!is_field(field, name_field)) continue;
    if (const auto name = harness::read_element_name(field.text)) bytes += name->element_bytes();
  }
  return bytes;
}

}  // namespace

Result<std::vector<Bytes>> write_requests(std::string_view address, std::string_view hex) {
  const std::optional<ElementName> name = harness::read_element_name(address);
  if (name && (name->area == 'F' || name->area == 'N'))
    return fail(fmt::format("{} is read only over the protocol", address));
  const Result<Plan> plan = plan_of(address, hex.size(), hex);
  if (!plan) return plan.error();
  std::vector<Bytes> requests;
  for (const Part& part : plan->parts) {
    Bytes body = request_head(write_command, plan->type, part.names.size());
    for (const std::string& one : part.names) put_name(body, one);
    const bool run = plan->type == continuous_type;
    const std::size_t block = run ? part.bytes : plan->element;
    for (std::size_t at = 0; at < part.data.size(); at += block)
      put_data(body, ByteView(part.data).subspan(at, block), run);
    requests.push_back(own_frame(body));
  }
  return requests;
}

Result<std::vector<Bytes>> read_requests(std::string_view address, std::size_t digits) {
  const Result<Plan> plan = plan_of(address, digits, "");
  if (!plan) return plan.error();
  std::vector<Bytes> requests;
  for (const Part& part : plan->parts) {
    Bytes body = request_head(read_command, plan->type, part.names.size());
    for (const std::string& one : part.names) put_name(body, one);
    if (plan->type == continuous_type) put_word(body, part.bytes);
    requests.push_back(own_frame(body));
  }
  return requests;
}

Status write_reply(ByteView reply) {
  if (const std::optional<std::string> why = refusal(reply)) return fail(*why);
  return ok();
}

Result<std::string> read_reply(ByteView reply) {
  if (const std::optional<std::string> why = refusal(reply)) return fail(*why);
  if (reply.size() < header_size + 4) return fail("the answer is cut short");
  const bool run = word_at(reply, header_size + 2) == continuous_type;
  std::string digits;
  for (Bytes& block : data_of(reply)) {
    if (!run) std::ranges::reverse(block);
    for (const Byte b : block) digits += hex_number(b, 2);
  }
  if (digits.empty()) return fail("the answer holds no data");
  return digits;
}

bool answers(ByteView request, ByteView reply) {
  constexpr std::size_t head = header_size + 4;  // with command and data type
  if (request.size() < head || reply.size() < head) return false;
  if (frame_length(reply) != reply.size()) return false;
  if (word_at(reply, invoke_at) != word_at(request, invoke_at)) return false;
  if (word_at(reply, header_size) != word_at(request, header_size) + 1) return false;
  if (word_at(reply, header_size + 2) != word_at(request, header_size + 2)) return false;
  const std::vector<Field> fields = explain(reply);
  if (find(fields, "error code")) return true;
  if (word_at(request, header_size) == write_command) return find(fields, "block count") != nullptr;
  return total(data_of(reply)) == bytes_asked_for(request);
}

Bytes probing_request(ByteView tested) {
  unsigned invoke = 0x7F01;
  const auto has = [&](unsigned id) {
    for (std::size_t i = 0; i + 1 < tested.size(); ++i)
      if (word_at(tested, i) == id) return true;
    return false;
  };
  while (has(invoke)) ++invoke;
  Bytes body = request_head(read_command, 2, 1);
  put_name(body, "%MW0");
  return frame_of(body, invoke);
}

Bytes read_of_bytes(unsigned count) {
  Bytes body = request_head(read_command, continuous_type, 1);
  put_name(body, "%MB0");
  put_word(body, count);
  return own_frame(body);
}

Bytes read_of_blocks(unsigned count) {
  Bytes body = request_head(read_command, 2, count);
  for (unsigned i = 0; i < count; ++i) put_name(body, "%MW0");
  return own_frame(body);
}

namespace {

/// Every place where a device might see a frame begin: behind each other frame, and at each company
/// id.
std::vector<std::size_t> beginnings(ByteView bytes) {
  std::vector<std::size_t> all;
  for (std::size_t at = 0; at < bytes.size();) {
    all.push_back(at);
    const std::optional<std::size_t> size = frame_length(bytes.subspan(at));
    if (!size) break;
    at += *size;
  }
  const std::string text = to_text(bytes);
  for (const std::string_view id : company_ids)
    for (std::size_t at = text.find(id); at != text.npos; at = text.find(id, at + 1))
      if (std::ranges::find(all, at) == all.end()) all.push_back(at);
  return all;
}

/// Of one frame that ends where its length field says, or at the end of what came.
std::vector<Protocol::Written> written_by_frame(ByteView frame, const plc::PlcModel* model) {
  if (frame.size() <= header_size || frame[header_size] != write_command) return {};
  std::vector<Protocol::Written> result;
  const std::vector<Field> fields = explain(frame);
  const bool run = frame.size() > header_size + 2 && frame[header_size + 2] == continuous_type;
  std::uint32_t count = 1;
  for (const Field& field : fields)
    if (run && is_field(field, size_field) && field.size == 2)
      count = std::max(count, word_at(frame, field.offset));
  for (const Field& field : fields)
    if (is_field(field, name_field)) result.push_back(harness::memory_at(model, field.text, count));
  if (result.empty()) result.push_back({"?", 0, ~0u, "an unknown place"});
  return result;
}

}  // namespace

std::vector<Protocol::Written> written_by(ByteView request, const plc::PlcModel* model) {
  std::vector<Protocol::Written> result;
  for (const std::size_t at : beginnings(request)) {
    const ByteView rest = request.subspan(at);
    std::vector<Protocol::Written> found = written_by_frame(rest, model);
    result.insert(result.end(), found.begin(), found.end());
  }
  return result;
}

std::vector<Protocol::AddressField> address_fields(ByteView request, const plc::PlcModel& model) {
  std::vector<Protocol::AddressField> result;
  if (request.size() < header_size + 4) return result;
  const std::vector<Field> fields = explain(request);
  std::uint32_t count = 1;
  for (const Field& field : fields) {
    const bool of_run = word_at(request, header_size + 2) == continuous_type;
    const bool counts = field.name == count_field || is_field(field, size_field);
    if (of_run && counts && field.size == 2) count = std::max(1u, word_at(request, field.offset));
  }
  for (const Field& field : fields) {
    if (!is_field(field, name_field)) continue;
    const plc::ParsedAddress parsed = plc::parse_address(model, field.text, true);
    if (!parsed) continue;
    result.push_back(
        {field.offset, field.size, harness::memory_of(model, parsed.address, count, field.text)});
  }
  return result;
}

}  // namespace fieldproof::xgt_fenet_suite
