/* svg.c - see svg.h.
 *
 * gnuplot escapes the texts in an SVG, but it writes tooltips as calls of a script that is not
 * there, gives each picture the same identifiers and calls all of them "Gnuplot". So a picture is
 * read as XML and written again from a list of what may stand in it: nothing else gets through,
 * whatever was in the texts. */
#include "report/svg.h"

#include <expat.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "report/markup.h"

enum { SVG_MAX_BYTES = 64 << 20, SVG_DEEPEST = 64 };

/* One picture on its way. */
struct cleaner {
    XML_Parser parser;
    const char *prefix; /* of identifiers, NULL: none */
    FILE *out;
    int depth;        /* of open elements */
    int skipped_from; /* depth of an element that is left out with all in it, 0: none */
    bool written;     /* the picture's own title is */
    struct text tip;  /* of the group that was just opened, for its title */
    bool in_title;    /* the text of a title is kept back until its end */
    struct text title;
    /* the largest text, found by a pass of its own */
    double size[SVG_DEEPEST], largest;
    struct text headline;
    bool in_headline;
};

static bool is_one_of(const char *word, const char *const *list)
{
    for (; *list; list++)
        if (strcmp(word, *list) == 0) return true;
    return false;
}

/* The value of an attribute, NULL: it has none. */
static const char *attribute(const char **pair, const char *name)
{
    for (; *pair; pair += 2)
        if (strcmp(pair[0], name) == 0) return pair[1];
    return NULL;
}

/* --- first pass: the largest text is what the picture is about -------------------------------- */

/* Sizes of fonts are inherited. */
static void note_element(void *context, const char *name, const char **pair)
{
    struct cleaner *c = context;
    const char *size = attribute(pair, "font-size");
    c->depth++;
    if (c->depth >= SVG_DEEPEST) return;
    c->size[c->depth] = size ? atof(size) : c->size[c->depth - 1];
    /* Of several texts of the largest size the first one counts. */
    if (strcmp(name, "text") == 0 && c->size[c->depth] > c->largest) {
        c->largest = c->size[c->depth];
        text_free(&c->headline);
        c->in_headline = true;
    }
}

static void note_end(void *context, const char *name)
{
    struct cleaner *c = context;
    c->depth--;
    if (strcmp(name, "text") == 0) c->in_headline = false;
}

static void note_text(void *context, const char *s, int n)
{
    struct cleaner *c = context;
    if (c->in_headline) text_add_bytes(&c->headline, s, (size_t)n);
}

/* --- second pass: what may stand in a page ---------------------------------------------------- */

/* Identifiers get the prefix, references to them too; a reference to anything else is dropped. */
static void put_attribute(struct cleaner *c, const char *name, const char *value)
{
    static const char *const allowed[] = {
        "x", "y", "x1", "x2", "y1", "y2", "cx", "cy", "r", "rx", "ry", "dx", "dy", "d", "points",
        "width", "height", "viewBox", "transform", "fill", "fill-opacity", "stroke", "color",
        "stroke-width", "stroke-opacity", "stroke-linecap", "stroke-linejoin", "stroke-dasharray",
        "opacity", "font-family", "font-size", "font-weight", "font-style", "text-anchor",
        "shape-rendering", NULL};
    const bool reference = strcmp(name, "xlink:href") == 0 || strcmp(name, "href") == 0;
    const bool identifier = strcmp(name, "id") == 0;
    /* references may point into the picture alone */
    if (reference ? *value != '#' : !identifier && !is_one_of(name, allowed)) return;
    /* A colour could be fetched from elsewhere. */
    if (strstr(value, "url(")) return;
    fprintf(c->out, " %s=\"%s", name, reference ? "#" : "");
    if ((reference || identifier) && c->prefix) markup_escape(c->out, c->prefix);
    markup_escape(c->out, value + reference);
    putc('"', c->out);
}

/* gnuplot_svg.showHypertext(evt,'TEXT'): TEXT becomes the title of the group. */
static void take_tip(struct cleaner *c, const char **pair)
{
    const char *call = attribute(pair, "onmousemove"), *from = call ? strchr(call, '\'') : NULL;
    const char *to = from ? strrchr(call, '\'') : NULL;
    /* A group without a call has no tip, whatever the one around it has. */
    text_free(&c->tip);
    if (to > from) text_add_bytes(&c->tip, from + 1, (size_t)(to - from - 1));
}

static void put_element(void *context, const char *name, const char **pair)
{
    static const char *const allowed[] = {"svg", "g", "path", "rect", "circle", "ellipse", "line",
                                          "polygon", "polyline", "use", "text", "tspan", "title",
                                          "defs", NULL};
    struct cleaner *c = context;
    c->depth++;
    if (c->skipped_from) return;
    if (!is_one_of(name, allowed)) {
        c->skipped_from = c->depth;
        return;
    }
    /* Whether a title is worth keeping is known at its end. */
    if (strcmp(name, "title") == 0) {
        text_free(&c->title);
        c->in_title = true;
        return;
    }
    if (strcmp(name, "g") == 0) take_tip(c, pair);
    /* The root gets its own names of spaces: those of the document are not copied. */
    const bool root = c->depth == 1;
    fprintf(c->out, "<%s", name);
    /* Groups need no identifiers: nothing refers to them. */
    for (; *pair; pair += 2)
        if (strcmp(name, "g") != 0 || strcmp(pair[0], "id") != 0)
            put_attribute(c, pair[0], pair[1]);
    if (root)
        fputs(" role=\"img\" xmlns=\"http://www.w3.org/2000/svg\""
              " xmlns:xlink=\"http://www.w3.org/1999/xlink\"",
              c->out);
    putc('>', c->out);
    if (root && c->headline.length > 0) {
        fputs("<title>", c->out);
        markup_escape_bytes(c->out, c->headline.s, c->headline.length);
        fputs("</title>", c->out);
    }
}

/* The title of a group: what its tooltip was to say, or the name of the curve. Names that gnuplot
 * makes up and its name for the whole picture are left out. */
static void put_title(struct cleaner *c)
{
    const struct text *t = c->tip.length > 0 ? &c->tip : &c->title;
    const bool made_up =
        t->length == 0 || strncmp(t->s, "gnuplot_plot_", 13) == 0 || strspn(t->s, " ") == t->length;
    c->in_title = false;
    /* Depth 2: below <svg>. */
    if (made_up || c->depth == 2) return;
    fputs("<title>", c->out);
    markup_escape_bytes(c->out, t->s, t->length);
    fputs("</title>", c->out);
}

static void put_end(void *context, const char *name)
{
    struct cleaner *c = context;
    /* What is left out ends where it began, with all in it. */
    if (c->skipped_from == 0) {
        if (c->in_title) put_title(c);
        else fprintf(c->out, "</%s>", name);
    } else if (c->skipped_from == c->depth) c->skipped_from = 0;
    c->depth--;
}

/* Texts, and the line breaks between elements. */
static void put_text(void *context, const char *s, int n)
{
    struct cleaner *c = context;
    if (c->in_title) text_add_bytes(&c->title, s, (size_t)n);
    else if (!c->skipped_from) markup_escape_bytes(c->out, s, (size_t)n);
}

/* One pass over the document. Entities are not declared: a document type could nest them without
 * end, and gnuplot writes none. */
static void refuse_type(void *context, const char *name, const char *system, const char *public,
                        int internal)
{
    struct cleaner *c = context;
    (void)name, (void)system, (void)public, (void)internal;
    XML_StopParser(c->parser, XML_FALSE);
}

static bool parse(struct cleaner *c, const struct text *svg, XML_StartElementHandler start,
                  XML_EndElementHandler end, XML_CharacterDataHandler text, struct err *e)
{
    c->depth = 0;
    c->parser = XML_ParserCreate("UTF-8");
    if (c->parser == NULL) return err_set(e, ERR_INTERNAL, "out of memory reading a picture");
    XML_SetUserData(c->parser, c);
    XML_SetElementHandler(c->parser, start, end);
    XML_SetCharacterDataHandler(c->parser, text);
    XML_SetStartDoctypeDeclHandler(c->parser, refuse_type);
    bool ok = XML_Parse(c->parser, svg->s, (int)svg->length, XML_TRUE) == XML_STATUS_OK;
    if (!ok && XML_GetErrorCode(c->parser) == XML_ERROR_NO_MEMORY)
        err_set(e, ERR_INTERNAL, "out of memory reading a picture");
    else if (!ok)
        err_set(e, ERR_DATA, "the picture is no SVG: line %lu: %s",
                (unsigned long)XML_GetCurrentLineNumber(c->parser),
                XML_ErrorString(XML_GetErrorCode(c->parser)));
    XML_ParserFree(c->parser);
    return ok;
}

bool svg_clean(const struct text *svg, const char *prefix, FILE *out, struct err *e)
{
    struct cleaner c = {.prefix = prefix, .out = out};
    /* expat takes lengths as int */
    if (!svg->s || svg->length > SVG_MAX_BYTES)
        return err_set(e, ERR_DATA, "the picture is empty or larger than %d bytes", SVG_MAX_BYTES);
    if (!prefix) fputs("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n", out);
    bool ok = parse(&c, svg, note_element, note_end, note_text, e) &&
              parse(&c, svg, put_element, put_end, put_text, e);
    if (ok) putc('\n', out);
    text_free(&c.tip);
    text_free(&c.title);
    text_free(&c.headline);
    return ok;
}
