#include "case_file/history_info.hpp"

#include "case_file/case_file.hpp"
#include "io/provenance.hpp"

namespace alphadot {

HistoryInfo history_info(const Case& c, const std::string& mesh_hash, const std::string& motion_table_hash) {
  HistoryInfo info;
  info.title = c.title;
  info.reference = c.reference;
  info.freestream = c.freestream;
  info.motion = c.motion;
  info.mesh_file = c.mesh.file;
  info.mesh_hash = mesh_hash;
  info.motion_table_hash = motion_table_hash;
  info.version = provenance(1).version;
  info.case_text = resolved_case(c);
  return info;
}

}  // namespace alphadot
