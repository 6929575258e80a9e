#pragma once

/* What the host needs to know of the loops that measure a processor: their sizes and their marks. */

enum {
  kFigOrder = 100,      /* of the system of equations */
  kFigRowLength = 201,  /* doubles from one column to the next, as the LINPACK benchmark has them */
  kFigNear = 512,       /* doubles of an array that stays in the data cache */
  kFigNearPasses = 40,
  kFigFar = 20000,      /* doubles of an array that does not, not a multiple of the cache */
  kFigFarPasses = 4,
  kFigWords = 1 << 18,  /* words that are read one after the other */
  kFigRecords = 60,     /* of the loop of integers */
  kFigRounds = 60,
  kFigNameBytes = 32
};

/* A mark 0x7002 says that a phase begins. */
#define FIG_PHASES(phase)                                                                       \
  phase(kFigPrepare, 1, "prepare") phase(kFigFactor, 2, "factor") phase(kFigSolve, 3, "solve") \
      phase(kFigNearLoop, 4, "daxpy_near") phase(kFigFarLoop, 5, "daxpy_far")                   \
          phase(kFigReadLoop, 6, "read_words") phase(kFigInteger, 7, "integers") phase(kFigCheck, 8, "check")
#define FIG_PHASE_NUMBER(name, number, text) name = number,
enum fig_phase { FIG_PHASES(FIG_PHASE_NUMBER) };
#undef FIG_PHASE_NUMBER
