#include "io/hdf5.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>

#include "core/error.hpp"
#include "io/foreign_files.hpp"
#include "io/hdf5_calls.hpp"
#include "io/hdf5_driver.hpp"

namespace alphadot::hdf5 {
namespace {

/// Reads one text, of fixed or variable length, through `read(memory type, buffer)`.
template <class Read>
std::string read_text_of(hid_t file_type, const std::string& file, const std::string& what, Read read) {
  if (H5Tget_class(file_type) != H5T_STRING) throw InputError(file, 0, what + ": it is not text");
  if (H5Tis_variable_str(file_type) > 0) {
    const Handle type(H5Tcopy(file_type), H5Tclose);
    char* text = nullptr;
    check(read(type.id(), &text), file, what);
    std::string out = text ? text : "";
    H5free_memory(text);
    return out;
  }
  const std::size_t size = H5Tget_size(file_type);
  if (size > std::filesystem::file_size(file)) throw InputError(file, 0, what + ": longer than the file");
  std::string out(size, '\0');
  check(read(file_type, out.data()), file, what);
  out.resize(std::min(out.size(), out.find('\0')));
  return out;
}

}  // namespace

// --- Object
// ---------------------------------------------------------------------------------------------------------

Object::Object(std::string file, std::string name, Handle handle)
    : file_(std::move(file)), name_(std::move(name)), handle_(std::move(handle)) {}

template <Element T>
void Object::write_attribute(const std::string& name, std::span<const T> values, bool is_array) {
  const std::string what = "cannot write attribute " + name + " of " + name_;
  if (has_attribute(name)) check(H5Adelete(handle_.id(), name.c_str()), file_, what);
  const auto size = static_cast<GlobalIndex>(values.size());
  const Handle space = is_array ? space_of(size, 0, size) : Handle(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute =
      owned(H5Acreate2(handle_.id(), name.c_str(), type_of<T>(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
            H5Aclose, file_, what);
  check(H5Awrite(attribute.id(), type_of<T>(), values.data()), file_, what);
}

void Object::set_attribute(const std::string& name, const std::string& text) {
  const std::string what = "cannot write attribute " + name + " of " + name_;
  if (has_attribute(name)) check(H5Adelete(handle_.id(), name.c_str()), file_, what);
  const Handle type = text_type(text.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute =
      owned(H5Acreate2(handle_.id(), name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
            file_, what);
  check(H5Awrite(attribute.id(), type.id(), text.c_str()), file_, what);
}

bool Object::has_attribute(const std::string& name) const {
  return H5Aexists(handle_.id(), name.c_str()) > 0;
}

template <Element T>
std::vector<T> Object::attributes(const std::string& name) const {
  const std::string what = "cannot read attribute " + name + " of " + name_;
  const Handle attribute = owned(H5Aopen(handle_.id(), name.c_str(), H5P_DEFAULT), H5Aclose, file_, what);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const auto count = static_cast<hsize_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space.id())));
  if (count > std::filesystem::file_size(file_) / std::max<std::size_t>(1, H5Tget_size(type.id())))
    throw InputError(file_, 0, what + ": more values than the file can hold");
  std::vector<T> values(static_cast<std::size_t>(count));
  check(H5Aread(attribute.id(), type_of<T>(), values.data()), file_, what);
  return values;
}

template <Element T>
T Object::attribute(const std::string& name) const {
  const auto values = attributes<T>(name);
  if (values.size() != 1)
    throw InputError(
        file_, 0,
        "attribute " + name + " of " + name_ + " must hold one value, not " + std::to_string(values.size()));
  return values.front();
}

std::string Object::text_attribute(const std::string& name) const {
  const std::string what = "cannot read attribute " + name + " of " + name_;
  const Handle attribute = owned(H5Aopen(handle_.id(), name.c_str(), H5P_DEFAULT), H5Aclose, file_, what);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (H5Sget_simple_extent_npoints(space.id()) != 1)
    throw InputError(file_, 0, what + ": it is not one text");
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  return read_text_of(type.id(), file_, what,
                      [&](hid_t memory, void* out) { return H5Aread(attribute.id(), memory, out); });
}

// --- Dataset
// --------------------------------------------------------------------------------------------------------

Dataset::Dataset(std::string file, std::string name, Handle handle)
    : Object(std::move(file), std::move(name), std::move(handle)) {
  const Handle space(H5Dget_space(handle_.id()), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (rank < 0 || rank > 2)
    throw InputError(file_, 0, "dataset " + name_ + " has " + std::to_string(rank) + " dimensions",
                     "it must have one or two");
  std::array<hsize_t, 2> size{1, 1};
  H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
  rank_ = rank;
  rows_ = static_cast<GlobalIndex>(size[0]);
  columns_ = static_cast<GlobalIndex>(size[1]);
}

bool Dataset::is_text() const {
  const Handle type(H5Dget_type(handle_.id()), H5Tclose);
  return H5Tget_class(type.id()) == H5T_STRING;
}

Handle Dataset::rows_space(GlobalIndex first_row, GlobalIndex count) const {
  if (first_row < 0 || count < 0 || first_row > rows_ - count)
    throw InputError(file_, 0,
                     "dataset " + name_ + " has no rows " + std::to_string(first_row) + " to " +
                         std::to_string(first_row + count));
  Handle space(H5Dget_space(handle_.id()), H5Sclose);
  const std::array<hsize_t, 2> start{static_cast<hsize_t>(first_row), 0};
  const std::array<hsize_t, 2> extent{static_cast<hsize_t>(count), static_cast<hsize_t>(columns_)};
  if (count == 0)
    H5Sselect_none(space.id());
  else if (rank_ > 0)
    H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr);
  return space;
}

template <Element T>
void Dataset::write(GlobalIndex first_row, std::span<const T> values) {
  const std::string what = "cannot write " + name_;
  const auto size = static_cast<GlobalIndex>(values.size());
  if (columns_ == 0 || size % columns_ != 0)
    throw InputError(file_, 0, what + ": the values do not fill whole rows");
  const Handle target = rows_space(first_row, size / columns_);
  const Handle source = space_of(size, 0, size);
  check(H5Dwrite(handle_.id(), type_of<T>(), source.id(), target.id(), H5P_DEFAULT, values.data()), file_,
        what);
}

template <Element T>
void Dataset::append(std::span<const T> values) {
  const GlobalIndex first_row = rows_;
  rows_ += static_cast<GlobalIndex>(values.size()) / std::max<GlobalIndex>(columns_, 1);
  const std::array<hsize_t, 2> size{static_cast<hsize_t>(rows_), static_cast<hsize_t>(columns_)};
  check(H5Dset_extent(handle_.id(), size.data()), file_, "cannot extend " + name_);
  write(first_row, values);
}

template <Element T>
std::vector<T> Dataset::read(GlobalIndex first_row, GlobalIndex count) const {
  const std::string what = "cannot read " + name_;
  check_storage();
  const Handle source = rows_space(first_row, count);
  const GlobalIndex size = count * columns_;
  const Handle target = space_of(size, 0, size);
  std::vector<T> values(static_cast<std::size_t>(size));
  check(H5Dread(handle_.id(), type_of<T>(), target.id(), source.id(), H5P_DEFAULT, values.data()), file_,
        what);
  return values;
}

std::string Dataset::read_text() const {
  const std::string what = "cannot read " + name_;
  if (rows_ != 1 || columns_ != 1) throw InputError(file_, 0, what + ": it is not one text");
  const Handle type(H5Dget_type(handle_.id()), H5Tclose);
  return read_text_of(type.id(), file_, what, [&](hid_t memory, void* out) {
    return H5Dread(handle_.id(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, out);
  });
}

void Dataset::check_storage() const {
  const Handle type(H5Dget_type(handle_.id()), H5Tclose);
  const auto bytes = static_cast<hsize_t>(H5Tget_size(type.id()));
  const auto length = static_cast<hsize_t>(std::filesystem::file_size(file_));
  const auto rows = static_cast<hsize_t>(rows_), columns = static_cast<hsize_t>(columns_);
  if (rows == 0 || columns == 0) return;
  const bool fits = columns <= length && bytes <= length && rows <= length / columns / bytes;
  if (!fits || H5Dget_storage_size(handle_.id()) < rows * columns * bytes)
    throw InputError(file_, 0, "dataset " + name_ + " holds less data than its size tells",
                     "the file is incomplete, compressed or damaged");
}

// --- Group
// ----------------------------------------------------------------------------------------------------------

Group Group::create_group(const std::string& name) const {
  const Handle list = without_times(H5P_GROUP_CREATE);
  return {file_, inside(name),
          owned(H5Gcreate2(handle_.id(), name.c_str(), with_groups_on_the_way().id(), list.id(), H5P_DEFAULT),
                H5Gclose, file_, "cannot create group " + inside(name))};
}

Group Group::group(const std::string& name) const {
  return {
      file_, inside(name),
      owned(H5Gopen2(handle_.id(), name.c_str(), H5P_DEFAULT), H5Gclose, file_, "no group " + inside(name))};
}

bool Group::has(const std::string& name) const {
  return H5Lexists(handle_.id(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Group::names() const {
  std::vector<std::string> found;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  check(H5Literate(handle_.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &found), file_,
        "cannot list " + name_);
  return found;
}

template <Element T>
Dataset Group::create_dataset(const std::string& name, GlobalIndex rows, GlobalIndex columns) const {
  const Handle list = without_times(H5P_DATASET_CREATE);
  H5Pset_fill_time(list.id(), H5D_FILL_TIME_NEVER);
  return add_dataset(name, type_of<T>(), space_of(rows, columns, rows), list);
}

template <Element T>
Dataset Group::create_growing(const std::string& name, GlobalIndex columns) const {
  const Handle list = without_times(H5P_DATASET_CREATE);
  const hsize_t width = static_cast<hsize_t>(std::max<GlobalIndex>(columns, 1));
  const std::array<hsize_t, 2> chunk{std::max<hsize_t>(1, 8192 / width), width};
  H5Pset_chunk(list.id(), columns > 0 ? 2 : 1, chunk.data());
  return add_dataset(name, type_of<T>(), space_of(0, columns, -1), list);
}

Dataset Group::add_dataset(const std::string& name, hid_t type, const Handle& space,
                           const Handle& list) const {
  return {file_, inside(name),
          owned(H5Dcreate2(handle_.id(), name.c_str(), type, space.id(), with_groups_on_the_way().id(),
                           list.id(), H5P_DEFAULT),
                H5Dclose, file_, "cannot create dataset " + inside(name))};
}

Dataset Group::dataset(const std::string& name) const {
  return {file_, inside(name),
          owned(H5Dopen2(handle_.id(), name.c_str(), H5P_DEFAULT), H5Dclose, file_,
                "no dataset " + inside(name))};
}

template <Element T>
Dataset Group::write(const std::string& name, std::span<const T> values, GlobalIndex columns) const {
  Dataset target = create_dataset<T>(
      name, static_cast<GlobalIndex>(values.size()) / std::max<GlobalIndex>(columns, 1), columns);
  target.write(0, values);
  return target;
}

void Group::write_text(const std::string& name, const std::string& text) const {
  const Handle type = text_type(text.size());
  const Dataset target = add_dataset(name, type.id(), Handle(H5Screate(H5S_SCALAR), H5Sclose),
                                     without_times(H5P_DATASET_CREATE));
  check(H5Dwrite(target.handle_.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()), file_,
        "cannot write " + inside(name));
}

void Group::write_texts(const std::string& name, const std::vector<std::string>& texts) const {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  check(H5Tset_size(type.id(), H5T_VARIABLE), file_, "cannot write " + inside(name));
  std::vector<const char*> pointers;
  pointers.reserve(texts.size());
  for (const auto& text : texts) pointers.push_back(text.c_str());
  const Dataset target =
      add_dataset(name, type.id(),
                  space_of(static_cast<GlobalIndex>(texts.size()), 0, static_cast<GlobalIndex>(texts.size())),
                  without_times(H5P_DATASET_CREATE));
  check(H5Dwrite(target.handle_.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()), file_,
        "cannot write " + inside(name));
}

// --- File
// -----------------------------------------------------------------------------------------------------------

File::File(const std::string& path, Handle file, Handle root, std::unique_ptr<int> write_error)
    : Group(path, "/", std::move(root)),
      write_error_(std::move(write_error)),
      file_handle_(std::move(file)) {}

File::~File() {
  handle_.close();  // the root group, before the file
}

File File::create(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  auto error = std::make_unique<int>(0);
  const Handle creation = without_times(H5P_FILE_CREATE), access = access_list();
  use_deferring_driver(access.id(), *error);
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  if (file.id() < 0 && *error != 0)
    throw InputError(path, 0, std::string("cannot be created: ") + std::strerror(*error));
  Handle root = owned(H5Gopen2(file.id(), "/", H5P_DEFAULT), H5Gclose, path, "cannot be created");
  return {path, std::move(file), std::move(root), std::move(error)};
}

File File::open(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  auto error = std::make_unique<int>(0);
  const Handle access = access_list();
  use_deferring_driver(access.id(), *error);
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id());
  if (*error != 0) throw InputError(path, 0, std::strerror(*error));
  if (id < 0)
    if (const auto problem = foreign_content(path, beginning_of(path), Expected::text))
      throw InputError(std::vector{*problem});
  Handle file = owned(id, H5Fclose, path, "not an HDF5 file, or an incomplete one");
  Handle root = owned(H5Gopen2(file.id(), "/", H5P_DEFAULT), H5Gclose, path, "has no root group");
  return {path, std::move(file), std::move(root), std::move(error)};
}

void File::close() {
  handle_.close();
  check(file_handle_.close(), file_, "cannot be completed");
  if (*write_error_ != 0)
    throw InputError(file_, 0, std::string("cannot be written: ") + std::strerror(*write_error_),
                     "check free space and quota");
}

// The types of element that the functions above are compiled for.
#define ALPHADOT_HDF5_ELEMENT(T)                                                                 \
  template void Object::write_attribute<T>(const std::string&, std::span<const T>, bool);        \
  template std::vector<T> Object::attributes<T>(const std::string&) const;                       \
  template T Object::attribute<T>(const std::string&) const;                                     \
  template void Dataset::write<T>(GlobalIndex, std::span<const T>);                              \
  template void Dataset::append<T>(std::span<const T>);                                          \
  template std::vector<T> Dataset::read<T>(GlobalIndex, GlobalIndex) const;                      \
  template Dataset Group::create_dataset<T>(const std::string&, GlobalIndex, GlobalIndex) const; \
  template Dataset Group::create_growing<T>(const std::string&, GlobalIndex) const;              \
  template Dataset Group::write<T>(const std::string&, std::span<const T>, GlobalIndex) const;
ALPHADOT_HDF5_ELEMENT(double)
ALPHADOT_HDF5_ELEMENT(float)
ALPHADOT_HDF5_ELEMENT(std::int32_t)
ALPHADOT_HDF5_ELEMENT(std::int64_t)
ALPHADOT_HDF5_ELEMENT(std::uint8_t)
#undef ALPHADOT_HDF5_ELEMENT

}  // namespace alphadot::hdf5
