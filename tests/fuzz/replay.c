/* replay [-v] FILE...: gives the fuzz target that it is linked with each file, without a fuzzer. -v: says what each calls. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

static int fail(const char *path)
{
    fprintf(stderr, "replay: can't read %s: name files that are there\n", path);
    return 1;
}

static int replay(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return fail(path);

    size_t size = 0, room = 4096, got;
    uint8_t *bytes = malloc(room);
    while (bytes && (got = fread(bytes + size, 1, room - size, file)) > 0)
        if ((size += got) == room)
            bytes = realloc(bytes, room *= 2);

    const bool is_bad = !bytes || ferror(file);
    fclose(file);
    if (is_bad)
        return free(bytes), fail(path);

    uint8_t *input = malloc(size ? size : 1); /* of its size, so that the sanitizers see its end */
    if (input) {
        memcpy(input, bytes, size);
        if (fuzz_verbose)
            printf("%s\n", path);
        LLVMFuzzerTestOneInput(input, size);
    }
    free(input);
    free(bytes);
    return input ? 0 : fail(path);
}

int main(int argc, char **argv)
{
    int first = 1, failed = 0;

    if (argc > 1 && strcmp(argv[1], "-v") == 0)
        fuzz_verbose = first++ == 1;
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ); /* for what comes before a fault */
    if (first == argc)
        return fprintf(stderr, "replay: no file: name one\n"), 1;
    for (int i = first; i < argc && !failed; i++)
        failed = replay(argv[i]);
    if (!failed)
        printf("%-40s %d inputs replayed\n", argv[0], argc - first);
    return failed;
}
