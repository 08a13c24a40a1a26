// Which link each step of a case uses, and whether that link is open then.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/vectors/case.hpp"
#include "src/base/result.hpp"

namespace fieldproof::vectors {

/// Goes through the steps of a case in their order.
class LinkNames {
 public:
  using IsLine = std::function<bool(const std::string& protocol)>;
  /// `network`: the case's protocol runs on a network. There a server has the links that the case
  /// opens, or the implicit one (""), and a client those that it opens itself, the last of them
  /// being the implicit one. A serial line is always there, as "".
  /// `lines`: the further protocols that run on a serial line; empty: none of them does.
  LinkNames(const Case& source, bool network, IsLine lines = {});

  /// The link that the step uses, opens or closes: its `on`, else the only one that is open; empty
  /// for steps that use none. Errors name the links that are open.
  Result<std::string> next(const Step& step);

  /// The bench opens a link at the beginning.
  bool implicit() const { return implicit_; }

 private:
  enum class State { open, half_closed, ended };  // half: the bench has sent its FIN
  struct Entry {
    std::string name;
    State state = State::open;
    bool datagrams = false;
    std::string line{};  // the protocol that runs on it, where it is a serial line
  };
  Result<std::string> opened(const Step& step);
  Result<std::string> opened_by_device(const Step& step);
  Result<Entry*> used(const Step& step);
  Entry* find(const std::string& name);
  std::string open_names() const;

  std::string line_of(const LinkSpec& link) const;

  const Case& source_;
  IsLine lines_;
  bool network_, client_, implicit_ = false;
  std::vector<Entry> entries_;
};

/// The second channel of the PLC under test (--aux): a link that is always open.
inline constexpr std::string_view aux_link = "aux";

/// All steps of a case; the error names the step.
Status check_links(const Case& source, bool network, LinkNames::IsLine lines = {});

}  // namespace fieldproof::vectors
