// Which link each step of a case is on.
#pragma once

#include <string>
#include <vector>

#include "harness/vectors/case.hpp"

namespace fieldproof::vectors {

/// The links of a case, step by step in order. A case that opens nothing and names nothing has one
/// link, whose name is "".
class Links {
 public:
  /// `named`: some step opens a link, or names one.
  explicit Links(bool named) : named_(named) {}

  /// Fills in `Step::on` where one link alone is open. Throws Broken where a step names none that
  /// is open, or leaves open which it means.
  void resolve(Step& step);

  /// Does this link carry datagrams?
  bool is_datagram(const std::string& name) const;

 private:
  struct Link {
    std::string name;
    Transport transport = Transport::tcp;
    bool ended = false;  // one side has closed it: who still means it names it
  };

  void open(const Step& step);
  Link& of(const Step& step);
  std::string open_links() const;

  bool named_;
  std::vector<Link> links_;
};

}  // namespace fieldproof::vectors
