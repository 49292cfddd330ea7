"""Text that is more than text in HTML, Markdown, LaTeX, a spreadsheet, a figure, a terminal, YAML or a shell."""

NASTY = (
    "=cmd|' /C calc'!A0 <script>alert(1)</script><img src=x onerror=alert(1)> [click](javascript:alert(1)) "
    '<javascript:alert(1)> ![x](javascript:alert(2)) [ref] \\input{/etc/passwd} \\write18{id} $\\frac{$ "quoted" a_b '
    "*c* %d #e ~f ^g &h; &#106; `i` {{7*7}} $(touch hit) ${x} | cell \x1b[31m\u202e \n# heading\n"
    "[ref]: javascript:alert(3)"
)
