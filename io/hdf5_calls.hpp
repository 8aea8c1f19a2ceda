// Calls of HDF5 as the wrapper makes them: failures become exceptions, identifiers become handles. For
// hdf5.cpp.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <type_traits>

#include "io/hdf5.hpp"

namespace alphadot::hdf5 {

/// HDF5's name of an element type.
template <class T>
hid_t type_of() {
  if constexpr (std::is_same_v<T, double>)
    return H5T_NATIVE_DOUBLE;
  else if constexpr (std::is_same_v<T, float>)
    return H5T_NATIVE_FLOAT;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return H5T_NATIVE_INT32;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return H5T_NATIVE_INT64;
  else
    return H5T_NATIVE_UINT8;
}

/// Throws InputError for the HDF5 call that has just failed, with the deepest reason HDF5 gives.
[[noreturn]] void fail(const std::string& file, const std::string& what);

/// `id` in a handle; fails when the call that gave it did.
Handle owned(hid_t id, Handle::Close close, const std::string& file, const std::string& what);

/// Fails when `status` says so.
void check(herr_t status, const std::string& file, const std::string& what);

/// A property list of `kind` that leaves times out of the file, so that equal runs write equal bytes.
Handle without_times(hid_t kind);

/// Links that make the groups on their way: "total/CA".
Handle with_groups_on_the_way();

/// A property list for access to a file, which closes all that is open in it and takes no locks.
Handle access_list();

/// A string type of exactly `size` bytes, without a final NUL.
Handle text_type(std::size_t size);

/// rows x columns (columns = 0: one dimension), extendible to `most_rows` (-1: without limit).
Handle space_of(GlobalIndex rows, GlobalIndex columns, GlobalIndex most_rows);

}  // namespace alphadot::hdf5
