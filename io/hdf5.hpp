// HDF5 files through handles that close themselves. Serial access from one rank: contiguous datasets without
// filters (extendible ones in chunks), no modification times, so that equal content makes equal files.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace alphadot::hdf5 {

/// Types of the elements of datasets and attributes.
template <class T>
concept Element = std::is_same_v<T, double> || std::is_same_v<T, float> || std::is_same_v<T, std::int32_t> ||
    std::is_same_v<T, std::int64_t> || std::is_same_v<T, std::uint8_t>;

/// Owns one HDF5 identifier and closes it with the function it was given.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle() = default;
  Handle(hid_t id, Close close_function) : id_(id), close_(close_function) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }

  hid_t id() const { return id_; }
  /// Closes now; negative on failure.
  herr_t close() { return id_ >= 0 ? close_(std::exchange(id_, H5I_INVALID_HID)) : 0; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// Anything in a file that has a name and attributes. Every function below throws InputError with the file's
/// name, what failed, and HDF5's own reason.
class Object {
 public:
  /// Makes or replaces an attribute: one number, several, or text (below 64 kB; longer text belongs in a
  /// dataset).
  template <Element T>
  void set_attribute(const std::string& name, T value) {
    write_attribute(name, std::span<const T>(&value, 1), false);
  }
  template <Element T>
  void set_attribute(const std::string& name, const std::vector<T>& values) {
    write_attribute(name, std::span<const T>(values), true);
  }
  void set_attribute(const std::string& name, const std::string& text);

  bool has_attribute(const std::string& name) const;
  /// All values of an attribute (one for a scalar), converted to T.
  template <Element T>
  std::vector<T> attributes(const std::string& name) const;
  /// The value of an attribute that holds exactly one.
  template <Element T>
  T attribute(const std::string& name) const;
  std::string text_attribute(const std::string& name) const;

  const std::string& file() const { return file_; }  ///< path of the file
  const std::string& name() const { return name_; }  ///< path inside the file, "/" for the root

 protected:
  Object(std::string file, std::string name, Handle handle);

  template <Element T>
  void write_attribute(const std::string& name, std::span<const T> values, bool is_array);

  std::string file_, name_;
  Handle handle_;
};

/// A table of rows x columns (columns = 1: one-dimensional).
class Dataset : public Object {
 public:
  GlobalIndex rows() const { return rows_; }
  GlobalIndex columns() const { return columns_; }
  bool is_text() const;

  /// Writes whole rows from `first_row` on; values are row by row.
  template <Element T>
  void write(GlobalIndex first_row, std::span<const T> values);
  /// Adds rows at the end of a dataset made with `create_growing`.
  template <Element T>
  void append(std::span<const T> values);
  /// Reads `count` whole rows from `first_row` on, converted to T. Only from files opened for reading.
  template <Element T>
  std::vector<T> read(GlobalIndex first_row, GlobalIndex count) const;
  /// Reads everything.
  template <Element T>
  std::vector<T> read() const {
    return read<T>(0, rows_);
  }
  std::string read_text() const;

 private:
  friend class Group;
  Dataset(std::string file, std::string name, Handle handle);
  Handle rows_space(GlobalIndex first_row, GlobalIndex count) const;
  /// No size in a file is trusted: refuses one whose data are not there.
  void check_storage() const;

  int rank_ = 1;  ///< dimensions in the file: 0 (scalar), 1 or 2
  GlobalIndex rows_ = 1, columns_ = 1;
};

/// Names may be paths inside the group; the groups on the way to something new are made.
class Group : public Object {
 public:
  Group create_group(const std::string& name) const;
  Group group(const std::string& name) const;  ///< opens
  bool has(const std::string& name) const;     ///< a link of that name in this group
  std::vector<std::string> names() const;      ///< of everything in this group, sorted

  /// A dataset of fixed size, to be written in pieces. columns = 0: one-dimensional.
  template <Element T>
  Dataset create_dataset(const std::string& name, GlobalIndex rows, GlobalIndex columns = 0) const;
  /// A dataset without rows that `append` extends.
  template <Element T>
  Dataset create_growing(const std::string& name, GlobalIndex columns = 0) const;
  Dataset dataset(const std::string& name) const;  ///< opens

  /// A dataset written at once.
  template <Element T>
  Dataset write(const std::string& name, std::span<const T> values, GlobalIndex columns = 0) const;
  template <Element T>
  Dataset write(const std::string& name, const std::vector<T>& values, GlobalIndex columns = 0) const {
    return write(name, std::span<const T>(values), columns);
  }
  void write_text(const std::string& name, const std::string& text) const;
  /// Texts of any length, without a NUL; marked as ASCII, which VTK's reader takes alone, whatever they hold.
  void write_texts(const std::string& name, const std::vector<std::string>& texts) const;

 protected:
  Group(std::string file, std::string name, Handle handle)
      : Object(std::move(file), std::move(name), std::move(handle)) {}

 private:
  Dataset add_dataset(const std::string& name, hid_t type, const Handle& space, const Handle& list) const;
  std::string inside(const std::string& name) const { return (name_ == "/" ? "" : name_) + "/" + name; }
};

/// An HDF5 file, as its root group.
class File : public Group {
 public:
  /// Replaces a file of that name. Errors of writing (a full disk) show at close().
  static File create(const std::string& path);
  static File open(const std::string& path);  ///< for reading
  File(File&&) = default;
  ~File();
  /// Writes out everything and closes, telling of failure as the destructor cannot. Ends the use of its
  /// objects.
  void close();

 private:
  File(const std::string& path, Handle file, Handle root, std::unique_ptr<int> write_error);
  std::unique_ptr<int> write_error_;  ///< errno of the first failed write, noted by the driver
  Handle file_handle_;
};

}  // namespace alphadot::hdf5
