// How HDF5 files reach the disk: a file driver that keeps failures of writing and closing from HDF5.
//
// When a write fails while HDF5 1.10 closes a file (a full disk), or the closing itself (a quota, a network),
// its identifier stays behind and points to freed memory: the process crashes later, inside MPI_Finalize. So
// this driver notes the first failure, pretends success to the end, and the owner of the file looks at the
// note after closing it. Failures of reading HDF5 is told of, and a file that was only read is closed
// whatever that says.
#pragma once

#include <hdf5.h>

namespace alphadot::hdf5 {

/// Makes files opened through `access_list` use the driver. The first error of the system (an
/// errno) is stored in `error`, which must outlive the file.
void use_deferring_driver(hid_t access_list, int& error);

}  // namespace alphadot::hdf5
