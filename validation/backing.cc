// SPDX-License-Identifier: Apache-2.0
#include "validation/backing.h"

namespace lorgnette::validation {
namespace {

struct Backing {
  const char* begins_with;
  std::vector<std::string> cases;
};

const std::vector<Backing>& Table() {
  static const std::vector<Backing> kTable = {
      {"back vertex power", {"V001", "V002", "V003", "V041", "V042", "V051", "V105"}},
      {"cylinder", {"V019", "V020", "V021", "V042", "V044", "V105"}},
      {"axis", {"V026", "V044", "V049", "V105"}},
      {"prism", {"V015", "V016", "V017", "V018", "V047", "V106"}},
      {"addition", {"V023", "V074"}},
      {"centre thickness", {"V046"}},
      {"least edge thickness", {"V014", "V045", "V046"}},
      {"base curve", {"V013", "V022"}},
      {"magnification", {"V043", "V048", "V060", "V061", "V064", "V070", "V071", "V073"}},
  };
  return kTable;
}

}  // namespace

std::vector<std::string> CasesBacking(const std::string& quantity) {
  for (const Backing& backing : Table()) {
    if (quantity.starts_with(backing.begins_with)) return backing.cases;
  }
  return {};
}

}  // namespace lorgnette::validation
