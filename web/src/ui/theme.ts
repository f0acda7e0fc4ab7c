// Light, dark, or as the system is.

const KEY = "infopart-theme";

function isDark(): boolean {
    const chosen = document.documentElement.dataset["theme"];
    return chosen === undefined ? matchMedia("(prefers-color-scheme: dark)").matches : chosen === "dark";
}

/** The theme that was chosen another day. */
export function restoreTheme(): void {
    const chosen = localStorage.getItem(KEY);
    if (chosen === "light" || chosen === "dark") {
        document.documentElement.dataset["theme"] = chosen;
    }
}

export function toggleTheme(): void {
    const theme = isDark() ? "light" : "dark";
    document.documentElement.dataset["theme"] = theme;
    localStorage.setItem(KEY, theme);
}
