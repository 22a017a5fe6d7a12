/* guest_sheet.c - what images declare, read and checked before any of their code runs.
 *
 * A wrong declaration is refused with the file's name and what was expected: from here on
 * others may rely on it. The image is mapped and relocated, and its constructors have not
 * run, so what is read is what the compiler wrote. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/text.h"
#include "guest/guest_program.h"
#include "guest/guest_world.h"
#include "spec/field.h"
#include "spec/program_list.h"

/* --- parameters as fields --------------------------------------------------------------------- */

/* Units in which parameters may be declared: those that settings of machines have, so
 * that values are written alike (`64 KiB`, `2 us`). */
static const struct {
    const char *name;
    enum unit unit;
} units[] = {{"", UNIT_NONE},
             {"B", UNIT_BYTES},
             {"s", UNIT_TIME},
             {"B/s", UNIT_BANDWIDTH},
             {"Hz", UNIT_FREQUENCY},
             {"flop/s", UNIT_FLOP_RATE},
             {"m", UNIT_LENGTH},
             {"kg", UNIT_MASS},
             {"N", UNIT_FORCE},
             {"rad", UNIT_ANGLE},
             {"m/s^2", UNIT_ACCELERATION},
             {"%", UNIT_PERCENT}};

static bool find_unit(const char *name, enum unit *unit)
{
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(name != NULL ? name : "", units[i].name) == 0)
            return *unit = units[i].unit, true;
    return false;
}

/* A word that can stand in scenarios and in SQL. At most 31 letters, digits
 * and lines below. */
static bool is_name(const char *s)
{
    if (s == NULL || !isalpha((unsigned char)*s) || strlen(s) > 31) return false;
    for (; *s != '\0'; s++)
        if (!isalnum((unsigned char)*s) && *s != '_') return false;
    return true;
}

/* "ring|doubling" as a list that NULL ends; NULL: a word is missing. TAKE zeroes the
 * list, which therefore ends with NULL; as many places as letters are always enough. */
static const char *const *split_choices(const char *text, struct arena *a)
{
    if (text == NULL) return NULL;
    char *rest = arena_text(a, text);
    const char **list = TAKE(a, strlen(text) + 2, const char *);
    for (int n = 0; rest != NULL; n++) {
        list[n] = strsep(&rest, "|");
        if (list[n][0] == '\0') return NULL;
    }
    return list;
}

/* A clause, because the caller puts file and parameter before it. */
static bool clause(char *why, int size, const char *text)
{
    snprintf(why, (size_t)size, "%s", text);
    return false;
}

/* The default, as text: what the variable holds in a copy in which nothing has run. */
static const char *fallback_of(const struct mimdsim_parameter *p, const struct field *f,
                               struct arena *a)
{
    union program_value v = {0};
    struct text t = {0};
    /* Kinds fix the C types of variables: int64_t, double, int and int
     * (mimdsim/program.h). */
    switch (p->kind) {
    case MIMDSIM_WHOLE:
        v.whole = *(const int64_t *)p->at;
        break;
    case MIMDSIM_REAL:
        v.real = *(const double *)p->at;
        break;
    case MIMDSIM_FLAG:
        v.flag = *(const int *)p->at != 0;
        break;
    default:
        v.choice = *(const int *)p->at;
        break;
    }
    /* Printing looks a choice up by its number. Also for a choice that the declaration
     * initialises out of its range. */
    int n = 0;
    while (f->choice != NULL && f->choice[n] != NULL) n++;
    if (f->choice != NULL && (v.choice < 0 || v.choice >= n)) return NULL;
    field_print(f, &v, &t);
    const char *text = arena_text(a, t.s);
    text_free(&t);
    return text;
}

bool guest_parameter_field(const struct mimdsim_parameter *p, struct field *f, struct arena *a,
                           char *why, int size)
{
    /* Declared kinds are part of the binary interface, kinds of fields are not. */
    static const enum field_kind kinds[] = {[MIMDSIM_WHOLE] = FIELD_INT64,
                                            [MIMDSIM_REAL] = FIELD_REAL,
                                            [MIMDSIM_FLAG] = FIELD_BOOL,
                                            [MIMDSIM_CHOICE] = FIELD_CHOICE};
    *f = (struct field){
        .key = p->name, .doc = p->doc != NULL ? p->doc : "", .min = p->least, .max = p->most};
    /* From here on in the order of the declaration, so that the first thing wrong is
     * told. */
    if (!is_name(p->name)) return clause(why, size, "a name is letters, digits and _, at most 31");
    if (p->kind < MIMDSIM_WHOLE || p->kind > MIMDSIM_CHOICE)
        return clause(why, size, "it has no such kind");
    if (p->at == NULL) return clause(why, size, "it has no variable");
    f->kind = kinds[p->kind];
    if (!find_unit(p->unit, &f->unit)) return clause(why, size, "its unit is not known");
    if (p->kind == MIMDSIM_WHOLE && f->unit != UNIT_NONE && f->unit != UNIT_BYTES)
        return clause(why, size, "whole numbers have no unit but B");
    if (p->kind == MIMDSIM_CHOICE && (f->choice = split_choices(p->choices, a)) == NULL)
        return clause(why, size, "its choices are not words between bars, such as ring|doubling");
    /* The image is unmapped after its sheet was read: texts are copied. */
    f->key = arena_text(a, p->name);
    f->doc = arena_text(a, f->doc);
    f->fallback = fallback_of(p, f, a);
    if (f->fallback == NULL)
        return clause(why, size, "its variable is not initialised with a place in its choices");
    char refused[200];
    /* The default must be within the declared range, by the same check as a user's value. */
    if (program_parameter_text(f, f->fallback, a, refused, (int)sizeof refused) != NULL)
        return true;
    snprintf(why, (size_t)size, "its variable is initialised with %s: %s", f->fallback, refused);
    return false;
}

void guest_parameters_set(const struct mimdsim_program *p, const char *lines, struct arena *a)
{
    for (int i = 0; i < MIMDSIM_PARAMETERS && p->parameter[i].name != NULL; i++) {
        const struct mimdsim_parameter *to = &p->parameter[i];
        union program_value v = {0};
        struct field f;
        char text[256], why[256];
        if (!program_value_find(lines, to->name, text, (int)sizeof text)) continue;
        /* Lines come from a plan that has checked them against the sheet of the same
         * image. */
        CHECK(guest_parameter_field(to, &f, a, why, (int)sizeof why));
        CHECK(field_set(&f, &v, text, a, why, (int)sizeof why));
        switch (to->kind) {
        /* Written into this copy alone: every rank and every part has its own variables. */
        case MIMDSIM_WHOLE:
            *(int64_t *)to->at = v.whole;
            break;
        case MIMDSIM_REAL:
            *(double *)to->at = v.real;
            break;
        case MIMDSIM_FLAG:
            *(int *)to->at = v.flag;
            break;
        default:
            *(int *)to->at = v.choice;
            break;
        }
    }
}

/* --- declarations ----------------------------------------------------------------------------- */

/* PROGRAM(...) of mimdsim/program.h makes this symbol; it points into the instance. */
const struct mimdsim_program *guest_declared(const struct loader_instance *i, struct arena *a)
{
    const struct mimdsim_program *p = loader_symbol(i, "mimdsim_program");
    /* What is not ours is refused by whoever reads it first. */
    if (p == NULL || p->magic != MIMDSIM_PROGRAM_MAGIC || p->size >= sizeof *p) return p;
    /* An older, smaller struct: behind its end lies something else. */
    struct mimdsim_program *whole = TAKE(a, 1, struct mimdsim_program);
    memcpy(whole, p, p->size);
    return whole;
}

static bool refuse(struct err *e, const char *path, const char *text)
{
    return err_set_at(e, ERR_DATA, path, 0, "%s", text);
}

/* Parameters of the declaration; a word that stands twice would be set twice. The list
 * ends with the first that has no name, or is full. */
static bool read_parameters(struct program_sheet *s, const struct mimdsim_program *p,
                            const char *path, struct arena *a, struct err *e)
{
    struct field *f = TAKE(a, MIMDSIM_PARAMETERS, struct field);
    s->parameter = f;
    for (int i = 0; i < MIMDSIM_PARAMETERS && p->parameter[i].name != NULL; i++) {
        char why[256];
        const char *name = p->parameter[i].name;
        if (!guest_parameter_field(&p->parameter[i], &f[i], a, why, (int)sizeof why))
            return err_set_at(e, ERR_DATA, path, 0, "parameter '%.40s' of the program: %s", name,
                              why);
        if (program_sheet_find(s, name) != NULL)
            return err_set_at(e, ERR_DATA, path, 0, "parameter '%.40s' is declared twice", name);
        s->nparameter = i + 1;
    }
    return true;
}

static bool read_declaration(struct program_sheet *s, const struct mimdsim_program *p,
                             const char *path, struct arena *a, struct err *e)
{
    /* Magic and version first: without them the rest is not what it seems. A larger
     * struct is a newer one, of which this simulator does not know all. */
    if (p->magic != MIMDSIM_PROGRAM_MAGIC)
        return refuse(e, path, "mimdsim_program is no declaration; PROGRAM(...) makes one");
    if (p->abi != MIMDSIM_PROGRAM_ABI || p->size > sizeof *p)
        return refuse(e, path,
                      "the program was made for another version of mimdsim; compile it again");
    if (p->run == NULL) return refuse(e, path, "the program declares no function .run");
    /* Written so that NaN is refused, too. */
    if (!(p->tolerance >= 0)) return refuse(e, path, ".tolerance is below zero or not a number");
    if (p->title != NULL) s->title = arena_text(a, p->title);
    if (p->name != NULL) text_copy(s->name, sizeof s->name, p->name);
    return read_parameters(s, p, path, a, e);
}

/* The file's name without folder and ending; of two programs of one name the built-in one has it.
 */
static void make_name(struct program_sheet *s, const char *path)
{
    /* A program's own name goes first, then the file's. Names of built-in programs keep
     * their meaning in scenarios and databases. */
    static const char *const built_in[] = {
#define X(word, stem, traits) word,
        PROGRAM_LIST(X)
#undef X
    };
    const char *base = strrchr(path, '/') != NULL ? strrchr(path, '/') + 1 : path;
    if (s->name[0] == '\0')
        snprintf(s->name, sizeof s->name, "%.*s", (int)strcspn(base, "."), base);
    if (s->name[0] == '\0') text_copy(s->name, sizeof s->name, base);
    for (size_t i = 0; i < sizeof built_in / sizeof *built_in; i++)
        if (strcmp(s->name, built_in[i]) == 0)
            snprintf(s->name, sizeof s->name, "%.24s-own", built_in[i]);
}

static bool read_image(struct program_sheet *s, struct loader_template *t, const char *path,
                       struct arena *a, struct err *e)
{
    static const struct loader_hooks none;
    /* One copy with no hooks: nothing of it will run. */
    struct loader_instance *i = NULL;
    if (loader_reserve(t, 1, &none, e)) i = loader_instantiate(t, 0, NULL, e);
    if (i == NULL) return false;
    const struct mimdsim_program *p = guest_declared(i, a);
    /* A declaration goes before main: a kernel may have both. */
    if (p != NULL) s->kind = PROGRAM_KERNEL;
    else if (loader_symbol(i, "main") != NULL || loader_symbol(i, "mimdsim_main") != NULL)
        s->kind = PROGRAM_MPI;
    else
        return refuse(e, path, "the program has neither PROGRAM(...) (mimdsim/program.h) nor main");
    const bool sound = p == NULL || read_declaration(s, p, path, a, e);
    make_name(s, path);
    return sound;
}

/* SHA-256 of the file identifies the program in databases; for sources the caller hands
 * over that of source and flags. */
static bool hash_image(struct program_sheet *s, const char *image, struct err *e)
{
    struct text file = {0};
    const bool read = text_read_file(&file, image, e);
    if (read) digest_sha256_hex(file.s, file.length, s->hash);
    text_free(&file);
    return read;
}

const struct program_sheet *guest_sheet(const char *image, const char *path, const char *hash,
                                        struct arena *a, struct err *e)
{
    struct program_sheet *s = TAKE(a, 1, struct program_sheet);
    *s = (struct program_sheet){.title = "", .image = arena_text(a, image)};
    text_copy(s->hash, sizeof s->hash, hash);
    if (hash[0] == '\0' && !hash_image(s, image, e)) return NULL;
    struct loader_template *t = loader_open(image, e);
    const bool fine = t != NULL && read_image(s, t, path, a, e);
    loader_close(t);
    return fine ? s : NULL;
}
