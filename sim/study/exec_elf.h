#pragma once

#include "sim/study/exec.h"

namespace dendro::study {

/// exec_program() for a machine whose programs are ELF files: in this process, with its standard input and
/// output.
ExecOutput exec_elf(const Catalogue& catalogue, const ExecArguments& arguments);

}  // namespace dendro::study
