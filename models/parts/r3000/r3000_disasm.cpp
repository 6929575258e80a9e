#include "models/parts/r3000/r3000_disasm.h"

#include <fmt/format.h>

#include "models/parts/r3000/r3000_decode.h"
#include "models/parts/r3010/r3010.h"

namespace dendro::r3000 {
namespace {

/// Names in the order of Op.
constexpr const char* kNames[] = {
    "nop",    "sll",  "srl",  "sra",  "sllv",  "srlv",  "srav",  "add",   "addu", "sub",     "subu",
    "and",    "or",   "xor",  "nor",  "slt",   "sltu",  "addi",  "addiu", "slti", "sltiu",   "andi",
    "ori",    "xori", "lui",  "mult", "multu", "div",   "divu",  "mfhi",  "mthi", "mflo",    "mtlo",
    "j",      "jal",  "jr",   "jalr", "beq",   "bne",   "blez",  "bgtz",  "bltz", "bgez",    "bltzal",
    "bgezal", "bc0f", "bc0t", "bc1f", "bc1t",  "lb",    "lbu",   "lh",    "lhu",  "lw",      "lwl",
    "lwr",    "mfc0", "mfc1", "cfc1", "sb",    "sh",    "sw",    "swl",   "swr",  "lwc1",    "swc1",
    "mtc0",   "mtc1", "ctc1", "fp",   "tlbr",  "tlbwi", "tlbwr", "tlbp",  "rfe",  "syscall", "break"};

constexpr const char* kConditions[] = {"f",  "un",   "eq",  "ueq", "olt", "ult", "ole", "ule",
                                       "sf", "ngle", "seq", "ngl", "lt",  "nge", "le",  "ngt"};

const char* fp_name(unsigned operation) {
  switch (operation) {
    case r3010::kAdd:
      return "add";
    case r3010::kSub:
      return "sub";
    case r3010::kMul:
      return "mul";
    case r3010::kDiv:
      return "div";
    case r3010::kAbs:
      return "abs";
    case r3010::kMov:
      return "mov";
    case r3010::kNeg:
      return "neg";
    case r3010::kCvtS:
      return "cvt.s";
    case r3010::kCvtD:
      return "cvt.d";
    case r3010::kCvtW:
      return "cvt.w";
    default:
      return nullptr;
  }
}

/// Empty: no instruction.
std::string fp_text(std::uint32_t w) {
  const unsigned code = w >> 21 & 31, operation = w & 63, ft = w >> 16 & 31, fs = w >> 11 & 31,
                 fd = w >> 6 & 31;
  const char* format = code == r3010::kSingle   ? "s"
                       : code == r3010::kDouble ? "d"
                       : code == r3010::kWord   ? "w"
                                                : nullptr;
  if (format == nullptr) return "";
  if (operation >= r3010::kCompare)
    return code == r3010::kWord || fd != 0
               ? ""
               : fmt::format("c.{}.{} $f{}, $f{}", kConditions[operation & 15], format, fs, ft);
  const char* name = fp_name(operation);
  const bool conversion = operation >= 32;
  if (name == nullptr || (code == r3010::kWord && (!conversion || operation == r3010::kCvtW))) return "";
  if ((operation == r3010::kCvtS && code == r3010::kSingle) ||
      (operation == r3010::kCvtD && code == r3010::kDouble))
    return "";
  if (operation <= r3010::kDiv) return fmt::format("{}.{} $f{}, $f{}, $f{}", name, format, fd, fs, ft);
  return ft != 0 ? "" : fmt::format("{}.{} $f{}, $f{}", name, format, fd, fs);
}

}  // namespace

const char* register_name(unsigned reg) {
  static const char* const kRegisters[] = {"$zero", "$at", "$v0", "$v1", "$a0", "$a1", "$a2", "$a3",
                                           "$t0",   "$t1", "$t2", "$t3", "$t4", "$t5", "$t6", "$t7",
                                           "$s0",   "$s1", "$s2", "$s3", "$s4", "$s5", "$s6", "$s7",
                                           "$t8",   "$t9", "$k0", "$k1", "$gp", "$sp", "$fp", "$ra"};
  return kRegisters[reg & 31];
}

std::string disassemble(std::uint32_t w, std::uint32_t address) {
  const Decoded d = decode(w);
  const std::string none = fmt::format(".word 0x{:08x}", w);
  if (w == 0) return "nop";
  if (d.op == Op::kReserved || d.op == Op::kCopUnusable) return none;
  // The decoder turns operations without effect into nop: the name comes from the fields then.
  Op op = d.op;
  if (op == Op::kNop) op = decode(w | 1u << 11).op;
  const char* name = kNames[static_cast<unsigned>(op)];
  const char* rs = register_name(rs_of(w));
  const char* rt = register_name(rt_of(w));
  const char* rd = register_name(rd_of(w));
  const auto immediate = static_cast<std::int32_t>(signed_immediate(w));
  const std::uint32_t target = address + d.imm;
  if (op == Op::kFp) {
    const std::string text = fp_text(w);
    return text.empty() ? none : text;
  }
  if (op <= Op::kSra) return fmt::format("{} {}, {}, {}", name, rd, rt, sa_of(w));
  if (op <= Op::kSrav) return fmt::format("{} {}, {}, {}", name, rd, rt, rs);
  if (op <= Op::kSltu) return fmt::format("{} {}, {}, {}", name, rd, rs, rt);
  if (op <= Op::kSltiu) return fmt::format("{} {}, {}, {}", name, rt, rs, immediate);
  if (op <= Op::kXori) return fmt::format("{} {}, {}, 0x{:x}", name, rt, rs, w & 0xFFFF);
  if (op == Op::kLui) return fmt::format("{} {}, 0x{:x}", name, rt, w & 0xFFFF);
  if (op <= Op::kDivu) return fmt::format("{} {}, {}", name, rs, rt);
  if (op == Op::kMfhi || op == Op::kMflo) return fmt::format("{} {}", name, rd);
  if (op == Op::kMthi || op == Op::kMtlo || op == Op::kJr) return fmt::format("{} {}", name, rs);
  if (op == Op::kJ || op == Op::kJal)
    return fmt::format("{} 0x{:x}", name, ((address + 4) & 0xF0000000) | d.imm);
  if (op == Op::kJalr) return fmt::format("{} {}, {}", name, rd, rs);
  if (op <= Op::kBne) return fmt::format("{} {}, {}, 0x{:x}", name, rs, rt, target);
  if (op <= Op::kBgezal) return fmt::format("{} {}, 0x{:x}", name, rs, target);
  if (op <= Op::kBc1t) return fmt::format("{} 0x{:x}", name, target);
  if (op == Op::kLwc1 || op == Op::kSwc1)
    return fmt::format("{} $f{}, {}({})", name, rt_of(w), immediate, rs);
  if (op == Op::kMfc0 || op == Op::kMtc0 || op == Op::kCfc1 || op == Op::kCtc1)
    return fmt::format("{} {}, ${}", name, rt, rd_of(w));
  if (op == Op::kMfc1 || op == Op::kMtc1) return fmt::format("{} {}, $f{}", name, rt, rd_of(w));
  if (op <= Op::kLwr || (op >= Op::kSb && op <= Op::kSwr))
    return fmt::format("{} {}, {}({})", name, rt, immediate, rs);
  return name;
}

bool is_mips1(std::uint32_t word) { return disassemble(word, 0)[0] != '.'; }

}  // namespace dendro::r3000
