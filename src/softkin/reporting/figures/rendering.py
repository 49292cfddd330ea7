"""A figure as PNG and as SVG, laid out once and drawn once: matplotlib's `savefig` draws each file twice."""

from __future__ import annotations

from io import StringIO
from pathlib import Path
from typing import Any, cast

import numpy as np
from matplotlib.backend_bases import FigureCanvasBase, GraphicsContextBase, RendererBase
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.backends.backend_mixed import MixedModeRenderer
from matplotlib.backends.backend_svg import RendererSVG
from matplotlib.figure import Figure
from PIL import Image

from softkin.core.files import replacing

DPI = 150
#: Pixels of a point.
SCALE = DPI / 72


def render(figure: Figure, stem: Path) -> None:
    """Write {stem}.png and {stem}.svg.

    The PNG has the 256 colours that suit it best: a third of the size, and no visible difference.
    """
    figure.set_dpi(DPI)
    renderer = Canvas(figure).renderer
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")
    figure.draw(renderer)
    with replacing(stem.with_suffix(".png")) as temporary:
        renderer.picture().quantize(256, dither=Image.Dither.NONE).save(temporary, format="png")
    with replacing(stem.with_suffix(".svg")) as temporary:
        temporary.write_text(renderer.drawing(), encoding="utf-8")


class Canvas(FigureCanvasBase):
    """Lets the layout measure text with the renderer that then draws it."""

    def __init__(self, figure: Figure) -> None:
        super().__init__(figure)
        self.renderer = BothRenderer(figure)

    def get_renderer(self) -> BothRenderer:
        """What matplotlib asks for when it measures."""
        return self.renderer


class BothRenderer(RendererBase):
    """Hands each path, mark, image and text of a figure to the renderer of pixels and to that of SVG.

    The drawing has the coordinates of the pixels, and the size of the figure; lengths that matplotlib counts in points
    (line widths, dashes, sizes of fonts) are scaled for it. An artist that is rasterized is an image in the drawing.
    """

    #: matplotlib sets it while it draws an artist that is rasterized.
    _rasterizing: bool

    def __init__(self, figure: Figure) -> None:
        super().__init__()
        width, height = figure.get_size_inches()
        self.size = (int(width * DPI), int(height * DPI))
        self.svg = StringIO()
        # matplotlib's backends have no types.
        agg, mixed, svg = cast(Any, RendererAgg), cast(Any, MixedModeRenderer), cast(Any, RendererSVG)
        self.pixels = agg(*self.size, DPI)
        self.vectors = mixed(figure, width, height, DPI, svg(*self.size, self.svg, metadata={"Date": None}))

    def picture(self) -> Image.Image:
        """What was drawn, in pixels."""
        return Image.fromarray(np.asarray(self.pixels.buffer_rgba())[..., :3])

    def drawing(self) -> str:
        """What was drawn, as SVG; nothing can be drawn after it."""
        self.vectors.finalize()
        width, height = self.size
        head = f'width="{width}pt" height="{height}pt"'
        return self.svg.getvalue().replace(head, f'width="{width / SCALE:g}pt" height="{height / SCALE:g}pt"', 1)

    def _of_svg(self, gc: GraphicsContextBase) -> GraphicsContextBase:
        """The look of lines in the drawing."""
        if self._rasterizing:
            return gc
        scaled = self.new_gc()
        scaled.copy_properties(gc)
        scaled.set_linewidth(gc.get_linewidth() * SCALE)
        scaled.set_dashes(*_scaled(gc.get_dashes()))
        return scaled

    def draw_path(self, gc: GraphicsContextBase, path: Any, transform: Any, rgbFace: Any = None) -> None:
        """One path."""
        self.pixels.draw_path(gc, path, transform, rgbFace)
        self.vectors.draw_path(self._of_svg(gc), path, transform, rgbFace)

    def draw_markers(
        self, gc: GraphicsContextBase, marker_path: Any, marker_trans: Any, path: Any, trans: Any, rgbFace: Any = None
    ) -> None:
        """A mark at each point of a path."""
        self.pixels.draw_markers(gc, marker_path, marker_trans, path, trans, rgbFace)
        self.vectors.draw_markers(self._of_svg(gc), marker_path, marker_trans, path, trans, rgbFace)

    def draw_path_collection(self, gc: GraphicsContextBase, *arguments: Any, **options: Any) -> None:
        """Many paths of one kind; of the arguments, the line widths and dashes are counted in points."""
        self.pixels.draw_path_collection(gc, *arguments, **options)
        *before, widths, dashes, antialiased, urls, position = arguments
        if not self._rasterizing:
            widths = [width * SCALE for width in widths]
            dashes = [_scaled(pattern) for pattern in dashes]
        self.vectors.draw_path_collection(
            self._of_svg(gc), *before, widths, dashes, antialiased, urls, position, **options
        )

    def draw_quad_mesh(self, gc: GraphicsContextBase, *arguments: Any, **options: Any) -> None:
        """A grid of cells, such as those of a colour bar."""
        self.pixels.draw_quad_mesh(gc, *arguments, **options)
        self.vectors.draw_quad_mesh(self._of_svg(gc), *arguments, **options)

    def draw_image(self, gc: GraphicsContextBase, x: float, y: float, im: Any, transform: Any = None) -> None:
        """An image, of the pixels of the picture: there is no `transform` unless `option_scale_image` says so."""
        assert transform is None
        self.pixels.draw_image(gc, x, y, im)
        self.vectors.draw_image(self._of_svg(gc), x, y, im)

    def draw_text(
        self,
        gc: GraphicsContextBase,
        x: float,
        y: float,
        s: str,
        prop: Any,
        angle: float,
        ismath: Any = False,
        mtext: Any = None,
    ) -> None:
        """One line of text."""
        self.pixels.draw_text(gc, x, y, s, prop, angle, ismath, mtext)
        if not self._rasterizing:
            prop = prop.copy()
            prop.set_size(prop.get_size_in_points() * SCALE)
        self.vectors.draw_text(self._of_svg(gc), x, y, s, prop, angle, ismath, mtext)

    def get_text_width_height_descent(self, s: str, prop: Any, ismath: Any) -> tuple[float, float, float]:
        """In pixels."""
        width, height, descent = self.pixels.get_text_width_height_descent(s, prop, ismath)
        return width, height, descent

    def get_canvas_width_height(self) -> tuple[float, float]:
        """In pixels."""
        return self.size

    def points_to_pixels(self, points: Any) -> Any:
        """Of a length."""
        return points * SCALE

    def option_image_nocomposite(self) -> bool:
        """Each image is drawn by itself."""
        return True

    def open_group(self, s: str, gid: str | None = None) -> None:
        """Of elements in the drawing."""
        self.vectors.open_group(s, gid)

    def close_group(self, s: str) -> None:
        """Of elements in the drawing."""
        self.vectors.close_group(s)

    def start_rasterizing(self) -> None:
        """What follows is an image in the drawing."""
        self.vectors.start_rasterizing()

    def stop_rasterizing(self) -> None:
        """The image is put into the drawing."""
        self.vectors.stop_rasterizing()


def _scaled(dashes: tuple[float, Any]) -> tuple[float, Any]:
    """Offset and lengths of dashes, in pixels."""
    offset, lengths = dashes
    return offset * SCALE, None if lengths is None else [length * SCALE for length in lengths]
