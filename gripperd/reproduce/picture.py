"""A drawing with the words that go with it, and how both stand on a page."""

from dataclasses import dataclass

from markupsafe import Markup, escape
from matplotlib.figure import Figure

from gripperd.reproduce import drawing


@dataclass(frozen=True, slots=True)
class Picture:
    """A drawing with the words that go with it."""

    name: str
    title: str
    caption: str
    alt: str
    """What it shows, for a reader who does not see it."""
    drawing: Figure

    def on_page(self, svg: str) -> dict[str, str]:
        """Give what a template needs, with the drawing as SVG."""
        return {
            "name": self.name,
            "title": self.title,
            "caption": self.caption,
            "markup": Markup(drawing.inline(svg, self.name, str(escape(self.alt)))),
        }
