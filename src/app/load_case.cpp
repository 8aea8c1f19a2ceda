#include "app/load_case.hpp"

#include <utility>

#include "app/described_case.hpp"
#include "case_file/case_file.hpp"
#include "core/error.hpp"
#include "derivatives/setup.hpp"

namespace alphadot {

Case load_case(const std::string& path, const std::vector<std::string>& overrides, const Communicator& comm) {
  std::string text;
  comm.on_root([&] { text = read_case_text(path); });
  text = comm.broadcast(text);
  CaseDraft draft;
  comm.on_all([&] {
    draft = draft_case(text, path, overrides);
    if (draft.problems.empty()) return;
    if (comm.is_root() && draft.is_readable) {
      const auto more = problems_of_files(draft.settings);
      draft.problems.insert(draft.problems.end(), more.begin(), more.end());
    }
    throw InputError(std::move(draft.problems));
  });
  make_mesh(draft.settings, comm);
  return std::move(draft.settings);
}

}  // namespace alphadot
