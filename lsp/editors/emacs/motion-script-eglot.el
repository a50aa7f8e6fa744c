;; Emacs with eglot (part of Emacs 29 and newer): in init.el.
(define-derived-mode motion-script-mode prog-mode "Motion Script"
  (setq-local comment-start "# ")
  (setq-local comment-start-skip "#+\\s-*"))
(add-to-list 'auto-mode-alist '("\\.ms\\'" . motion-script-mode))
(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(motion-script-mode . ("mlmg" "lsp" "--stdio"))))
(add-hook 'motion-script-mode-hook #'eglot-ensure)
