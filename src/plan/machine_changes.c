/* machine_changes.c - how the machine of a run differs from the shipped one; see
 * machine_changes.h.
 *
 * A claim counts only runs on machines as shipped, so every run stores what was changed, as
 * JSON, and a hash of the machine that it was compared with. */
#include "plan/machine_changes.h"

#include <string.h>
#include <unistd.h>

#include "base/digest.h"
#include "base/text.h"
#include "plan/machine_file.h"
#include "spec/field.h"
#include "spec/spec_fields.h"

/* One shipped machine. */
struct shipped_machine {
    const char *name;
    struct machine_spec spec; /* as the file describes it */
    const char
        *text; /* "machine.key = value" lines without the network level; NULL: none is shipped */
    char hash[65];    /* SHA-256 of `text`, "" when there is none */
    struct shipped_machine *next;
};

/* Lines of the machine's canonical text that ask something of it, but are not the machine. */
static bool is_question(const char *line)
{
    static const char *const key[] = {"machine.network.level = ", "machine.network.tolerance = "};
    for (size_t i = 0; i < sizeof key / sizeof *key; i++)
        if (strncmp(line, key[i], strlen(key[i])) == 0) return true;
    return false;
}

/* The canonical text without those lines. */
static void describe(const struct machine_spec *m, struct text *out)
{
    struct text all = {0};
    fields_print(&machine_table, m, false, &all);
    for (const char *line = all.s; line && *line;) {
        const char *end = strchrnul(line, '\n');
        if (*end) end++;
        if (!is_question(line)) text_add_bytes(out, line, (size_t)(end - line));
        line = end;
    }
    text_free(&all);
}

/* Where the machine of this name is shipped. */
static void shipped_path(const char *name, struct text *path)
{
    text_add(path, "%s/machines/%s.yaml", plan_data_dir(), name);
}

/* Remember what is shipped under this name: `spec`, NULL where there is none. */
static struct shipped_machine *add_shipped(struct machine_changes *c, const char *name,
                                           const struct machine_spec *spec)
{
    struct shipped_machine *s = TAKE(c->arena, 1, struct shipped_machine);
    struct text text = {0};
    s->name = arena_text(c->arena, name);
    if (spec != NULL) {
        s->spec = *spec;
        describe(spec, &text);
        s->text = arena_text(c->arena, text.s);
        digest_sha256_hex(text.s, text.length, s->hash);
    }
    text_free(&text);
    s->next = c->known;
    return c->known = s;
}

/* The machine of that name as shipped; without text when there is none. A user's own machine of
 * the same name does not count. */
static struct shipped_machine *read_shipped(struct machine_changes *c, const char *name)
{
    struct text path = {0};
    struct machine_file file;
    struct err ignored;
    err_clear(&ignored);
    shipped_path(name, &path);
    /* A name with a slash would lead out of the folder. */
    const bool there = !strchr(name, '/') && access(path.s, R_OK) == 0 &&
                       machine_file_read(&file, path.s, NULL, c->arena, &ignored);
    text_free(&path);
    return add_shipped(c, name, there ? &file.spec : NULL);
}

/* The rest of the line of `text` that begins with the `n` letters at `key`; NULL when there is
 * none. */
static const char *line_of(const char *text, const char *key, size_t n)
{
    for (const char *line = text; *line; line += strcspn(line, "\n"), line += *line == '\n')
        if (strncmp(line, key, n) == 0) return line + n;
    return NULL;
}

/* "value" in JSON: what has a meaning there is escaped. */
static void add_quoted(struct text *out, const char *s, size_t n)
{
    text_add(out, "\"");
    for (size_t i = 0; i < n; i++)
        if (s[i] == '"' || s[i] == '\\') text_add(out, "\\%c", s[i]);
        else if ((unsigned char)s[i] < ' ') text_add(out, "\\u%04x", s[i]);
        else text_add_bytes(out, &s[i], 1);
    text_add(out, "\"");
}

/* Lines of `own` whose value is another one in `shipped`, as the members of a JSON object. */
static void add_differences(struct text *out, const char *own, const char *shipped)
{
    static const char prefix[] = "machine.";
    for (const char *line = own; *line;) {
        const char *end = strchrnul(line, '\n'),
                   *equals = memmem(line, (size_t)(end - line), " = ", 3);
        if (equals) {
            /* The key without "machine.", as machine files have it. */
            const char *key = line + strlen(prefix), *value = equals + 3;
            size_t length = (size_t)(end - value);
            /* A key that the shipped text lacks is newer than it: a difference, too. */
            const char *there = line_of(shipped, line, (size_t)(value - line));
            if (!there || strcspn(there, "\n") != length || memcmp(there, value, length) != 0) {
                text_add(out, "%s", out->length > 1 ? ", " : "");
                add_quoted(out, key, (size_t)(equals - key));
                text_add(out, ": ");
                add_quoted(out, value, length);
            }
        }
        line = *end ? end + 1 : end;
    }
}

void machine_changes_between(const struct machine_spec *from, const struct machine_spec *own,
                             struct text *out)
{
    struct text before = {0}, now = {0}, members = {0};
    /* Mostly nothing was changed: the structs are the same bytes, and nothing is printed. */
    if (memcmp(from, own, sizeof *own) != 0) {
        describe(from, &before);
        describe(own, &now);
        text_add(&members, "{");
        add_differences(&members, now.s, before.s);
    }
    text_add(out, "%s}", members.s != NULL ? members.s : "{");
    text_free(&before);
    text_free(&now);
    text_free(&members);
}

/* What is remembered of that name; NULL: nothing yet. */
static const struct shipped_machine *known(const struct machine_changes *c, const char *name)
{
    for (const struct shipped_machine *s = c->known; s; s = s->next)
        if (strcmp(s->name, name) == 0) return s;
    return NULL;
}

/* Read once per plan and name. */
static const struct shipped_machine *shipped(struct machine_changes *c, const char *name)
{
    const struct shipped_machine *s = known(c, name);
    return s != NULL ? s : read_shipped(c, name);
}

/* Mostly the machine of a plan is the shipped file itself: it need not be read a second time. */
void machine_changes_read(struct machine_changes *c, const char *path,
                          const struct machine_spec *spec)
{
    struct text own = {0};
    shipped_path(spec->name, &own);
    if (strcmp(own.s, path) == 0 && known(c, spec->name) == NULL) add_shipped(c, spec->name, spec);
    text_free(&own);
}

/* Whether two machines are one but for what is asked of them. Structs are compared as bytes, since
 * specs begin as zeros; equal bytes have equal texts, which take longer to print. */
static bool is_same(const struct machine_spec *shipped, const struct machine_spec *own)
{
    struct machine_spec x = *shipped;
    x.network.level = own->network.level;
    x.network.tolerance = own->network.tolerance;
    return memcmp(&x, own, sizeof x) == 0;
}

/* Notes in *run what differs. The texts live in c->arena, as long as the plan. */
void machine_changes_note(struct machine_changes *c, struct run_spec *run)
{
    /* Runs of a sweep mostly share their machine: the last answer is kept. */
    if (!c->any || memcmp(&c->last, &run->machine, sizeof c->last) != 0) {
        const struct shipped_machine *s = shipped(c, run->machine.name);
        struct text own = {0}, changes = {0};
        text_add(&changes, "{");
        if (s->text && !is_same(&s->spec, &run->machine)) {
            describe(&run->machine, &own);
            if (strcmp(own.s, s->text) != 0) add_differences(&changes, own.s, s->text);
        }
        text_add(&changes, "}");
        /* NULL: nothing to compare with; "{}": as shipped. */
        c->text = s->text ? arena_text(c->arena, changes.s) : NULL;
        c->hash = s->hash;
        memcpy(&c->last, &run->machine, sizeof c->last);
        c->any = true;
        text_free(&own);
        text_free(&changes);
    }
    run->machine_changes = c->text;
    run->machine_hash = c->hash;
}
