/* build.h - which build wrote a row: version, source, compiler; made by src/store/local.am. */
#ifndef STORE_BUILD_H
#define STORE_BUILD_H

struct build {
    const char *version;    /* of the package */
    const char
        *git; /* commit, "-dirty" when files differ; without git "src-" and a hash of the sources */
    const char *compiler;
    const char *flags;      /* of the C compiler */
};

/* store_build: the build of this program; strings live for ever. */
struct build store_build(void);

#endif
