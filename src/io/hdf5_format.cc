// Looks into an HDF5 file for the marks of the layouts that can be read.
#include "io/formats.h"

#include "core/error.h"
#include "io/gadget_hdf5.h"
#include "io/h5md.h"
#include "io/phantom_hdf5.h"

namespace motes {

namespace {

bool has_hdf5_signature(std::string_view head) { return head.starts_with("\x89HDF\r\n\x1a\n"); }

std::unique_ptr<Trajectory> open_hdf5(const std::filesystem::path& path,
                                      const ReadOptions& options) {
  Hdf5File file(path, options);
  if (is_h5md(file)) return open_h5md(std::move(file), options);
  if (is_phantom_hdf5(file)) return open_phantom_hdf5(std::move(file), options);
  if (is_gadget_hdf5(file)) return open_gadget_hdf5(std::move(file), options);
  const std::string expected =
      "expected PartType0 to PartType6 (GADGET, AREPO, SWIFT, GIZMO), particles/xyz (Phantom) or "
      "h5md (H5MD)";
  if (!file.text("/", "openPMD").empty()) {
    throw Error(path, "is an openPMD file, which Motes does not read; " + expected);
  }
  throw Error(path, "is an HDF5 file of an unknown layout; " + expected);
}

}  // namespace

const Format& hdf5_format() {
  static const Format format{"HDF5 (GADGET, AREPO, SWIFT, GIZMO, Phantom, H5MD)",
                             {".hdf5", ".h5", ".h5md"},
                             has_hdf5_signature,
                             open_hdf5};
  return format;
}

}  // namespace motes
