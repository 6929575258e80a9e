#pragma once

#include <string>

#include "sim/base/scratch_file.h"

namespace dendro::zbuffer_views {

/// Puts the CRC-32 of a file of views into the word that the programs write as 0 and ignore, and takes it out again. `views` is one
/// that check_views() accepts, the word 0 before and after.
void put_checksum(base::ScratchFile& views);
void take_checksum(base::ScratchFile& views);

/// Of a file that check_views() accepts: compares the checksum, if it has one, checks the values of colours, views and samples, and
/// leaves the file as the program wrote it. Throws UserError naming `path`.
void check_saved_views(base::ScratchFile& views, const std::string& path);

}  // namespace dendro::zbuffer_views
