/* command.c - sources, stages and outputs among the options of gcc. */
#include "compile/command.h"

#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "compile/option_list.h"

static const char *const with_word[] = {
#define X(option) option,
    OPTION_WORD_LIST(X)
#undef X
        NULL};

static const char *const dropped[] = {
#define X(option) option,
    OPTION_DROPPED_LIST(X)
#undef X
        NULL};

static const char *const refused[][2] = {
#define X(option, why) {option, why},
    OPTION_REFUSED_LIST(X)
#undef X
        {NULL, NULL}};

/* Options after which no code is made; gcc answers them itself. */
static const char *const questions[] = {"-E",
                                        "-M",
                                        "-MM",
                                        "-fsyntax-only",
                                        "-###",
                                        "--version",
                                        "--help*",
                                        "-print-*",
                                        "-dumpversion",
                                        "-dumpmachine",
                                        "-dumpspecs",
                                        "-dumpfullversion",
                                        "--target-help",
                                        "--print-*",
                                        NULL};

/* Endings by which gcc knows languages (its manual, "Overall Options"). */
static const char *const assembly_endings[] = {"s", "S", "sx", NULL};
static const char *const source_endings[] = {
    "c",   "i",   "ii",  "cc",  "cp",  "cxx", "cpp", "CPP", "c++", "C",   "f",   "for", "ftn", "F",
    "FOR", "fpp", "FPP", "FTN", "f90", "f95", "f03", "f08", "F90", "F95", "F03", "F08", NULL};
static const char *const header_endings[] = {"h",   "H",   "hh",  "hp",  "hxx",
                                             "hpp", "HPP", "h++", "tcc", NULL};

/* A word of the list that ends in '*' stands for all words that begin so. */
static bool among(const char *word, const char *const *list)
{
    for (; *list != NULL; list++) {
        const size_t n = strlen(*list);
        if ((*list)[n - 1] == '*' ? strncmp(word, *list, n - 1) == 0 : strcmp(word, *list) == 0)
            return true;
    }
    return false;
}

/* Behind the last dot of the file's name; a dot in the name of a folder is none. */
static const char *ending_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash != NULL ? slash : path, '.');
    return dot != NULL ? dot + 1 : "";
}

/* The language that -x names decides, whatever the file is called. */
static bool is_assembly(const char *path, const char *language)
{
    if (language != NULL) return strncmp(language, "assembler", 9) == 0;
    return among(ending_of(path), assembly_endings);
}

/* Options that cannot work here are refused with the reason, and not passed on to fail later. */
static bool refuse(const char *word, struct err *e)
{
    for (int i = 0; refused[i][0] != NULL; i++) {
        const char *const one[] = {refused[i][0], NULL};
        if (among(word, one))
            return !err_set(e, ERR_USAGE, "%s is not possible: %s", word, refused[i][1]);
    }
    return false;
}

/* --- one word of the line --- */

struct reading {
    struct command *c;
    struct arena *arena;
    struct text flags;
    const char *language; /* of -x, for the files behind it */
    int capacity;
    bool linker_input; /* a library or an object */
    bool question, header;
};

/* What gcc would do with the file: compile it, or hand it to the linker. The word keeps its
 * place on the link line, where the object's path replaces it, as the order of libraries matters
 * there. */
static void take_file(struct reading *r, const char *path)
{
    struct command *c = r->c;
    const bool assembly = is_assembly(path, r->language);
    if (r->language == NULL && among(ending_of(path), header_endings)) r->header = true;
    else if (r->language != NULL && strstr(r->language, "header") != NULL) r->header = true;
    else if (assembly || r->language != NULL || among(ending_of(path), source_endings)) {
        if (c->nsource == r->capacity) {
            const int capacity = r->capacity > 0 ? 2 * r->capacity : 16;
            struct command_source *more = TAKE(r->arena, capacity, struct command_source);
            if (c->nsource > 0) memcpy(more, c->source, (size_t)c->nsource * sizeof *more);
            c->source = more;
            r->capacity = capacity;
        }
        c->source[c->nsource++] = (struct command_source){path, r->language, assembly, c->link.n};
    } else r->linker_input = true;
    words_add(&c->link, path);
}

/* Options that say what to do and where to; false: not one of them. */
static bool take_stage(struct reading *r, const char *word, const char *value)
{
    struct command *c = r->c;
    if (strcmp(word, "-c") == 0) {
        if (c->stage == COMMAND_LINK) c->stage = COMMAND_OBJECT;
    } else if (strcmp(word, "-S") == 0) c->stage = COMMAND_ASSEMBLY;
    else if (strcmp(word, "-o") == 0) c->output = value;
    else if (strncmp(word, "-o", 2) == 0 && word[2] != '\0' && word[2] != '-') c->output = word + 2;
    else if (strcmp(word, "-x") == 0)
        r->language = value == NULL || strcmp(value, "none") == 0 ? NULL : value;
    else if (strncmp(word, "-x", 2) == 0)
        r->language = strcmp(word, "-xnone") == 0 ? NULL : word + 2;
    else return false;
    return true;
}

/* The options of make's dependency files. They go to the compiler alone, as the names in them
 * are made from the final output and not from the assembly in between. */
static bool take_dependency(struct command *c, const char *word, const char *value)
{
    if (strcmp(word, "-MD") == 0 || strcmp(word, "-MMD") == 0) c->writes_dependencies = true;
    else if (strncmp(word, "-MF", 3) == 0) c->names_dependency_file = true;
    else if (strncmp(word, "-MT", 3) == 0 || strncmp(word, "-MQ", 3) == 0)
        c->names_dependency_target = true;
    else return false;
    words_add(&c->dependencies, word);
    if (value != NULL) words_add(&c->dependencies, value);
    return true;
}

/* What only the linker needs: libraries, and what is handed on to it. */
static bool take_linker_option(struct reading *r, const char *word, const char *value)
{
    struct command *c = r->c;
    const bool library = strncmp(word, "-l", 2) == 0;
    c->shared = c->shared || strcmp(word, "-shared") == 0;
    c->relocatable = c->relocatable || strcmp(word, "-r") == 0;
    if (!library && strncmp(word, "-Wl,", 4) != 0 && strcmp(word, "-Xlinker") != 0) return false;
    words_add(&c->link, word);
    if (value != NULL) words_add(&c->link, value);
    r->linker_input = r->linker_input || library;
    return true;
}

/* Any other option is for every step that may know it: the compiler and the linker's gcc; what
 * is marked for the assembler goes there alone. */
static void take_option(struct reading *r, const char *word, const char *value)
{
    struct command *c = r->c;
    if (take_stage(r, word, value) || among(word, dropped)) return;
    if (take_dependency(c, word, value) || take_linker_option(r, word, value)) return;
    struct words *const to[] = {&c->compile, &c->link};
    const bool assembler = strncmp(word, "-Wa,", 4) == 0 || strcmp(word, "-Xassembler") == 0;
    for (int i = 0; i < 2; i++) {
        struct words *w = assembler ? &c->assemble : to[i];
        words_add(w, word);
        if (value != NULL) words_add(w, value);
        if (assembler) return;
    }
    /* What acts on the code is told in the object's note; folders do not. */
    if (strstr(word, "-prefix-map=") != NULL) return;
    if (word[1] == 'O' || word[1] == 'f' || word[1] == 'm' || strncmp(word, "-std=", 5) == 0)
        text_add(&r->flags, "%s%s", r->flags.length > 0 ? " " : "", word);
}

/* A lone "-" is the standard input, which is a file. */
static bool take_word(struct reading *r, const char *word, const char *value, struct err *e)
{
    if (word[0] != '-' || word[1] == '\0') take_file(r, word);
    else if (refuse(word, e)) return false;
    else {
        r->question = r->question || among(word, questions);
        take_option(r, word, value);
    }
    return true;
}

/* Reads the line as gcc does, left to right, and then decides what kind of line it was. */
bool command_read(struct command *c, int n, const char *const *word, struct arena *a, struct err *e)
{
    struct words all = {.arena = a};
    struct reading r = {.c = c, .arena = a};
    *c = (struct command){.stage = COMMAND_LINK};
    c->compile.arena = c->assemble.arena = c->link.arena = c->dependencies.arena = a;
    bool fine = words_expand(&all, n, word, e);
    for (int i = 0; fine && i < all.n; i++) {
        const bool takes_value = among(all.word[i], with_word) && i + 1 < all.n;
        fine = take_word(&r, all.word[i], takes_value ? all.word[i + 1] : NULL, e);
        i += takes_value;
    }
    /* The flags are told in the note of each object, so that one compiled otherwise can be
     * recognised. */
    c->flags = arena_text(a, r.flags.s != NULL ? r.flags.s : "");
    text_free(&r.flags);
    if (!fine) return false;
    /* Questions, precompiled headers and lines without any file are gcc's own affair. */
    if (r.question || r.header || (c->nsource == 0 && !r.linker_input)) c->stage = COMMAND_PASS;
    /* -c and -S make one output a source; -o names one only. */
    const bool single = c->stage == COMMAND_ASSEMBLY || c->stage == COMMAND_OBJECT;
    if (single && c->nsource == 0) c->stage = COMMAND_PASS; /* gcc says what is missing */
    if (single && c->output != NULL && c->nsource > 1)
        return err_set(e, ERR_USAGE, "-o %s with -c or -S is for one source file; %d are given",
                       c->output, c->nsource);
    return true;
}

/* As gcc does: in the working folder, with the source's name. */
const char *command_default_output(const char *source, const char *ending, struct arena *a)
{
    const char *slash = strrchr(source, '/'), *name = slash != NULL ? slash + 1 : source;
    const char *dot = strrchr(name, '.');
    const int stem = dot != NULL && dot != name ? (int)(dot - name) : (int)strlen(name);
    char *output = arena_take(a, (size_t)stem + strlen(ending) + 2);
    sprintf(output, "%.*s.%s", stem, name, ending);
    return output;
}

/* gcc would name the target and the file after what it writes, which is assembly on a pipe; so
 * both are named here unless the user did. */
void command_dependency_words(const struct command *c, int i, const char *object, struct words *w)
{
    const char *source = c->source[i].path, *base = command_default_output(source, "d", w->arena),
               *file = base;
    words_add_all(w, c->dependencies.n, c->dependencies.word);
    if (!c->writes_dependencies) return;
    if (!c->names_dependency_target) {
        words_add(w, "-MQ");
        words_add(w, c->stage == COMMAND_LINK ? command_default_output(source, "o", w->arena)
                                              : object);
    }
    if (c->names_dependency_file) return;
    /* Beside the output: foo/bar.o has foo/bar.d; sources that are linked at once have
     * PROGRAM-SOURCE.d. */
    if (c->stage == COMMAND_LINK) {
        const char *program = c->output != NULL ? c->output : "a";
        char *path = arena_take(w->arena, strlen(program) + strlen(base) + 2);
        sprintf(path, "%s-%s", program, base);
        file = path;
    } else if (c->output != NULL) {
        const char *slash = strrchr(c->output, '/');
        const char *name = command_default_output(c->output, "d", w->arena);
        const int folder = slash != NULL ? (int)(slash - c->output) + 1 : 0;
        char *path = arena_take(w->arena, (size_t)folder + strlen(name) + 1);
        sprintf(path, "%.*s%s", folder, c->output, name);
        file = path;
    }
    words_add(w, "-MF");
    words_add(w, file);
}
