#include "io/hdf5_calls.hpp"

#include <algorithm>
#include <array>

#include "core/error.hpp"

namespace alphadot::hdf5 {

namespace {

/// The deepest entry of HDF5's error stack; of an error of the system only its message.
std::string reason() {
  std::string text;
  const auto first = [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
    auto& found = *static_cast<std::string*>(out);
    if (found.empty() && error->desc) found = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, first, &text);
  const std::string mark = "error message = '";
  if (const auto begin = text.find(mark); begin != std::string::npos) {
    text.erase(0, begin + mark.size());
    text.resize(std::min(text.size(), text.find('\'')));
  }
  return text;
}

}  // namespace

void fail(const std::string& file, const std::string& what) {
  const std::string why = reason();
  throw InputError(file, 0, what + (why.empty() ? "" : ": " + why));
}

Handle owned(hid_t id, Handle::Close close, const std::string& file, const std::string& what) {
  if (id < 0) fail(file, what);
  return Handle(id, close);
}

void check(herr_t status, const std::string& file, const std::string& what) {
  if (status < 0) fail(file, what);
}

Handle without_times(hid_t kind) {
  Handle list(H5Pcreate(kind), H5Pclose);
  H5Pset_obj_track_times(list.id(), false);
  return list;
}

Handle with_groups_on_the_way() {
  Handle list(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(list.id(), 1);
  return list;
}

Handle access_list() {
  Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(list.id(), H5F_CLOSE_STRONG);
  H5Pset_file_locking(list.id(), false, true);  // files are replaced whole, never written while read
  return list;
}

Handle text_type(std::size_t size) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(size, 1));
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

Handle space_of(GlobalIndex rows, GlobalIndex columns, GlobalIndex most_rows) {
  const std::array<hsize_t, 2> size{static_cast<hsize_t>(rows), static_cast<hsize_t>(columns)};
  const std::array<hsize_t, 2> limit{most_rows < 0 ? H5S_UNLIMITED : static_cast<hsize_t>(most_rows),
                                     size[1]};
  return Handle(H5Screate_simple(columns > 0 ? 2 : 1, size.data(), limit.data()), H5Sclose);
}

}  // namespace alphadot::hdf5
