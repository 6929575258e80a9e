#include "firmware/lib/mips/dendro.h"

/* Its arguments, then its standard input, and as exit code how many there were. */
int main(int argc, char** argv) {
  char text[100];
  for (int i = 1; i < argc; ++i) printf("argument %d: %s\n", i, argv[i]);
  long all = 0, got;
  while ((got = dendro_call(kSysRead, 0, (long)text, sizeof text)) > 0) {
    dendro_call(kSysWrite, 1, (long)text, got);
    all += got;
  }
  printf("%ld bytes\n", all);
  dendro_mark(kMarkLabel, 1);
  return argc - 1;
}
